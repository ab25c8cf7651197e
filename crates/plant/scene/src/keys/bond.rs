//! Bonds between grains.

use super::unit;
use serde::Deserialize;

/// `[[bond]]`
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bond {
    /// Two names of materials.
    pub between: [String; 2],
    /// What it resists.
    #[serde(default)]
    pub kind: BondKind,
    /// Which grains, by their clusters.
    #[serde(default)]
    pub clusters: Clusters,
    /// Largest gap between two surfaces that is bonded [m].
    #[serde(deserialize_with = "unit::metres")]
    pub gap: f64,
    /// When bonds are made [s].
    #[serde(default, deserialize_with = "unit::seconds")]
    pub at: f64,
    /// Radius of a bond over the smaller of both particles' [–]; absent: 1.
    #[serde(default, deserialize_with = "unit::plain")]
    pub radius_ratio: Option<f64>,
    /// Young's modulus of beams [Pa].
    #[serde(default, deserialize_with = "unit::pascals")]
    pub young: Option<f64>,
    /// Their Poisson's ratio [–], for the shear modulus.
    #[serde(default, deserialize_with = "unit::plain")]
    pub poisson: Option<f64>,
    /// Modulus of parallel and contact bonds [Pa].
    #[serde(default, deserialize_with = "unit::pascals")]
    pub modulus: Option<f64>,
    /// Their normal over shear stiffness [–].
    #[serde(default, deserialize_with = "unit::plain")]
    pub stiffness_ratio: Option<f64>,
    /// Normal stiffness of contact bonds [N/m].
    #[serde(default, deserialize_with = "unit::newtons_a_metre")]
    pub normal_stiffness: Option<f64>,
    /// Their shear stiffness [N/m].
    #[serde(default, deserialize_with = "unit::newtons_a_metre")]
    pub shear_stiffness: Option<f64>,
    /// Normal stiffness of parallel bonds per area [Pa/m].
    #[serde(default, deserialize_with = "unit::pascals_a_metre")]
    pub normal_stiffness_per_area: Option<f64>,
    /// Their shear stiffness per area [Pa/m].
    #[serde(default, deserialize_with = "unit::pascals_a_metre")]
    pub shear_stiffness_per_area: Option<f64>,
    /// Share of moments in the stress that breaks a parallel bond [–]; absent: 1.
    #[serde(default, deserialize_with = "unit::plain")]
    pub moments: Option<f64>,
    /// Tension at the rim that breaks one [Pa]; absent: none does.
    #[serde(default, deserialize_with = "unit::pascals")]
    pub tensile_strength: Option<f64>,
    /// Shear that breaks one [Pa]; absent: none does.
    #[serde(default, deserialize_with = "unit::pascals")]
    pub shear_strength: Option<f64>,
    /// Tension that breaks a contact bond [N].
    #[serde(default, deserialize_with = "unit::newtons")]
    pub tensile_force: Option<f64>,
    /// Shear that breaks a contact bond [N].
    #[serde(default, deserialize_with = "unit::newtons")]
    pub shear_force: Option<f64>,
    /// Tensile over shear strength [–], instead of one of them.
    #[serde(default, deserialize_with = "unit::plain")]
    pub strength_ratio: Option<f64>,
    /// Angle by which pressure adds to the shear strength [rad].
    #[serde(default, deserialize_with = "unit::radians")]
    pub friction_angle: Option<f64>,
    /// Standard deviation of strengths over their mean [–].
    #[serde(default, deserialize_with = "unit::plain")]
    pub deviation: Option<f64>,
    /// Weibull's m of strengths [–].
    #[serde(default, deserialize_with = "unit::plain")]
    pub weibull_modulus: Option<f64>,
    /// Radius of bonds of which strengths are the scale [m].
    #[serde(default, deserialize_with = "unit::metres")]
    pub reference_radius: Option<f64>,
    /// Seed of the strengths that are drawn.
    pub seed: Option<u64>,
    /// γ of dashpots beside the springs [–]; absent: none.
    #[serde(default, deserialize_with = "unit::plain")]
    pub damping: Option<f64>,
    /// Whether the two are not in contact besides; absent: as its kind has it.
    pub replaces_contact: Option<bool>,
}

/// Keys of a `[[bond]]` of which either has its strengths drawn.
pub const DRAWN: [&str; 2] = ["deviation", "weibull_modulus"];

/// What a bond resists.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum BondKind {
    /// A beam from centre to centre.
    #[default]
    Beam,
    /// Cement between the surfaces.
    Parallel,
    /// Glue at a point.
    Contact,
}

/// Which grains are bonded, by their clusters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Clusters {
    /// Of one cluster, or both of none.
    #[default]
    Same,
    /// Of two clusters.
    Different,
    /// All.
    Any,
}

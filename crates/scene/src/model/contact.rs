//! Materials, and what they do to each other.

use serde::Deserialize;

/// `[[material]]`
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Name.
    pub name: String,
    /// Density [kg/m³]; walls need none.
    pub density: Option<f64>,
    /// Young's modulus [Pa].
    pub young: f64,
    /// Poisson's ratio [–].
    pub poisson: f64,
}

/// `[[contact]]`
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// Two names of materials; "*" stands for every one.
    pub between: [String; 2],
    /// Normal law.
    #[serde(default)]
    pub law: Law,
    /// k_n of "hooke" [N/m].
    pub stiffness: Option<f64>,
    /// Speed of impact at which "hooke" is as deep as "hertz" [m/s]; in place of `stiffness`.
    pub characteristic_velocity: Option<f64>,
    /// k_t/k_n of "hooke" [–].
    pub tangential_ratio: Option<f64>,
    /// Restitution [–].
    pub restitution: f64,
    /// w of "jkr" [J/m²].
    pub work_of_adhesion: Option<f64>,
    /// Cohesion of "hertz" and "hooke"; absent: none.
    pub cohesion: Option<Cohesion>,
    /// Its energy density [J/m³].
    pub cohesion_energy_density: Option<f64>,
    /// μ [–], or how it depends on speed; absent: frictionless.
    pub sliding_friction: Option<Friction>,
    /// μ_r [–]; absent: none.
    pub rolling_resistance: Option<f64>,
    /// Its model; absent: a spring.
    pub rolling_model: Option<RollingModel>,
    /// μ_w [–]; absent: none.
    pub twisting_resistance: Option<f64>,
}

/// `[[bond]]`
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bond {
    /// Two names of materials.
    pub between: [String; 2],
    /// Largest gap between two surfaces at t = 0 that is bonded [m].
    pub gap: f64,
    /// Radius of a bond over the smaller of both particles' [–]; absent: 1.
    pub radius_ratio: Option<f64>,
    /// Young's modulus of bonds [Pa].
    pub young: f64,
    /// Their Poisson's ratio [–], for the shear modulus.
    pub poisson: f64,
    /// Tension at the rim that breaks one [Pa]; absent: none does.
    pub tensile_strength: Option<f64>,
    /// Shear that breaks one [Pa]; absent: none does.
    pub shear_strength: Option<f64>,
    /// γ of dashpots beside the springs [–]; absent: none.
    pub damping: Option<f64>,
}

/// Normal law of a contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Law {
    /// Hertz–Mindlin.
    #[default]
    Hertz,
    /// Linear.
    Hooke,
    /// Hertz with adhesion: Johnson, Kendall and Roberts.
    Jkr,
}

/// Model of cohesion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Cohesion {
    /// A pull proportional to the area of contact.
    Sjkr,
}

/// Model of rolling resistance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum RollingModel {
    /// A spring and dashpot, capped.
    Spring,
    /// A couple of constant size.
    Constant,
}

/// μ: a number, or a table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Friction {
    /// The same at every speed [–].
    Constant(f64),
    /// Weaker the faster the contact slides.
    Weakening(Weakening),
}

/// μ_d + (μ_s − μ_d)/(1 + (v/v_c)²)
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Weakening {
    /// μ_s, at rest [–].
    #[serde(rename = "static")]
    pub at_rest: f64,
    /// μ_d, far above the speed [–].
    pub dynamic: f64,
    /// v_c, at which it is half-way [m/s].
    pub speed: f64,
}

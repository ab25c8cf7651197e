//! Bonds between particles: what holds for all bonds of two materials, and the numbers of one bond.

use geom::Vec3;
use nalgebra::UnitQuaternion;
use serde::{Deserialize, Serialize};

/// Bonds between particles of two materials that are close to each other at one time. They act until they break.
#[derive(Debug, Clone, PartialEq)]
pub struct Bond {
    /// The two materials, by index, in any order.
    pub between: (u16, u16),
    /// Which particles of these materials, by their clusters.
    pub clusters: Clusters,
    /// Largest gap between two surfaces that is bonded [m].
    pub gap: f64,
    /// When the bonds are made [s]; at the first step from then on.
    pub at: f64,
    /// What they resist, and how.
    pub kind: BondKind,
    /// λ, radius of a bond over the smaller of both particles' [–].
    pub radius_ratio: f64,
    /// When they break.
    pub strength: BondStrength,
    /// γ: dashpots are this share of √(k m*) of the stiffest motion of the two, in proportion to stiffness [–]; 0: none, 2: critical.
    pub damping: f64,
    /// Whether the two are not in contact besides as long as the bond holds.
    pub replaces_contact: bool,
}

impl Bond {
    /// Bonds made at t = 0 up to a gap [m] that never break: as thick as the smaller particle, without dashpots.
    pub fn new(between: (u16, u16), gap: f64, kind: BondKind) -> Bond {
        let (clusters, strength) = (Clusters::Same, BondStrength::INFINITE);
        let replaces_contact = matches!(kind, BondKind::Contact(_));
        Bond {
            between,
            clusters,
            gap,
            at: 0.0,
            kind,
            radius_ratio: 1.0,
            strength,
            damping: 0.0,
            replaces_contact,
        }
    }

    /// Whether it may bond two particles of these materials and clusters whose surfaces are `open` apart [m].
    pub fn joins(&self, [a, b]: [u16; 2], [c, d]: [u32; 2], open: f64) -> bool {
        (self.between == (a, b) || self.between == (b, a)) && self.clusters.allow(c, d) && open <= self.gap
    }
}

/// Which two particles may be bonded, by their clusters. Particles without a cluster count as one cluster.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Clusters {
    /// Of one cluster.
    #[default]
    Same,
    /// Of two clusters.
    Different,
    /// All.
    Any,
}

impl Clusters {
    /// For messages, after "particles".
    pub fn said(self) -> &'static str {
        match self {
            Clusters::Same => " and of one cluster",
            Clusters::Different => " and of two clusters",
            Clusters::Any => "",
        }
    }

    /// Whether particles of these clusters may be bonded.
    pub fn allow(self, a: u32, b: u32) -> bool {
        match self {
            Clusters::Same => a == b,
            Clusters::Different => a != b,
            Clusters::Any => true,
        }
    }
}

/// The cluster of a particle in a list by id; 0: none.
pub fn cluster_of(clusters: &[(u32, u32)], id: u32) -> u32 {
    clusters.binary_search_by_key(&id, |c| c.0).map_or(0, |at| clusters[at].1)
}

/// Puts a particle into a cluster, in a list by id.
pub fn join(clusters: &mut Vec<(u32, u32)>, id: u32, cluster: u32) {
    match clusters.binary_search_by_key(&id, |c| c.0) {
        Ok(at) => clusters[at].1 = cluster,
        Err(at) => clusters.insert(at, (id, cluster)),
    }
}

/// What a bond resists, and how. L: its length; A = π r², I = π r⁴/4, J = 2 I of its round section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BondKind {
    /// An elastic beam from centre to centre: E A/L, 12 E I/L³, E I/L, G J/L.
    Beam {
        /// Young's modulus E [Pa].
        young: f64,
        /// Shear modulus G [Pa].
        shear_modulus: f64,
    },
    /// Cement between two surfaces: springs per area k_n and k_s [Pa/m], and so k_n A, k_s A, k_n I, k_s J (Potyondy & Cundall 2004,
    /// doi:10.1016/j.ijrmms.2004.09.011).
    Parallel {
        /// k_n and k_s [Pa/m]; of a modulus E: k_n = E/(r_i + r_j).
        springs: BondSprings,
        /// β, share of the moments in the stress that breaks it [–].
        moments: f64,
    },
    /// Glue at a point, without moments: k_n and k_s [N/m]; of a modulus E: k_n = 2 E (r_i + r_j).
    Contact(BondSprings),
}

/// Normal and shear springs of a bond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BondSprings {
    /// k_n and k_s.
    Given([f64; 2]),
    /// From a modulus.
    Modulus {
        /// E [Pa].
        modulus: f64,
        /// k_n/k_s [–].
        ratio: f64,
    },
}

/// When bonds break: by a tension σ > σ_c, or by a shear τ > τ_c + σ_p tan φ, where σ_p is the mean pressure on the section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BondStrength {
    /// σ_c [Pa], or [N] where forces are given; infinite: never.
    pub tension: f64,
    /// τ_c [Pa], or [N]; infinite: never.
    pub shear: f64,
    /// tan φ [–].
    pub friction: f64,
    /// Whether strengths are forces [N], which are divided by the section of each bond.
    pub forces: bool,
    /// How strengths of single bonds differ.
    pub spread: Spread,
    /// Seed of what is drawn.
    pub seed: u64,
}

impl BondStrength {
    /// Of bonds that never break.
    pub const INFINITE: BondStrength = BondStrength {
        tension: f64::INFINITY,
        shear: f64::INFINITY,
        friction: 0.0,
        forces: false,
        spread: Spread::None,
        seed: 0,
    };

    /// Of these σ_c and τ_c [Pa].
    pub fn of(tension: f64, shear: f64) -> BondStrength {
        BondStrength { tension, shear, ..BondStrength::INFINITE }
    }
}

/// How the strengths of single bonds differ: one factor a bond, on tension and shear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Spread {
    /// Not at all.
    None,
    /// Normal distribution with mean 1; what is not above 0 is drawn again.
    Normal {
        /// Standard deviation over the mean [–].
        deviation: f64,
    },
    /// Weibull distribution: P(factor > x) = exp(−x^m V/V_0). Weibull (1951), J. Appl. Mech. 18.
    Weibull {
        /// m [–].
        modulus: f64,
        /// Radius r_0 of the bonds whose scale the strengths are [m]: V/V_0 = (r/r_0)³; `None`: the same for all sizes.
        reference_radius: Option<f64>,
    },
}

/// The numbers of one bond.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BondNumbers {
    /// Direction from j to i when it was made, as j has turned since its turn is counted.
    pub axis: Vec3,
    /// From the turn of i to that of j when it was made: q_i⁻¹ q_j.
    pub reference: UnitQuaternion<f64>,
    /// L and r [m].
    pub size: [f64; 2],
    /// Distance of its section from the centre of i over L [–]; that of j is the rest.
    pub share: f64,
    /// Springs against stretching and shear [N/m], bending and twist [N·m/rad].
    pub stiffness: [f64; 4],
    /// Dashpots over springs [s].
    pub lag: f64,
    /// Share of moments in the stress [–].
    pub moments: f64,
    /// Whether moments count at the centres, as of a beam, or at the section between both.
    pub at_ends: bool,
    /// σ_c, τ_c [Pa], and tan φ [–].
    pub strength: [f64; 3],
    /// Whether the two are not in contact besides.
    pub replaces_contact: bool,
}

impl BondNumbers {
    /// The same seen from the other end.
    pub fn flipped(&self) -> BondNumbers {
        // Axes are those of the second end.
        let axis = -(self.reference * self.axis);
        BondNumbers { axis, reference: self.reference.inverse(), share: 1.0 - self.share, ..*self }
    }

    /// Tension and shear that it resists at a mean tension [Pa].
    pub fn resists(&self, mean: f64) -> [f64; 2] {
        resists(self.strength, mean)
    }
}

/// Tension and shear that a bond of σ_c, τ_c [Pa] and tan φ resists at a mean tension [Pa].
pub fn resists([tension, shear, friction]: [f64; 3], mean: f64) -> [f64; 2] {
    [tension, (shear - mean * friction).max(0.0)]
}

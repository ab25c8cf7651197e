//! Bonds, as a setup asks for them.

/// Bonds between the particles of two materials that are close to each other at t = 0: round elastic beams between the centres, as long as these
/// are apart, with the radius λ min(r_i, r_j). They act beside contacts, until they break.
#[derive(Debug, Clone, PartialEq)]
pub struct Bond {
    /// The two materials, by index, in any order.
    pub between: (u16, u16),
    /// Largest gap between two surfaces at t = 0 that is bonded [m].
    pub gap: f64,
    /// λ, radius of the beam over the smaller of both [–].
    pub radius_ratio: f64,
    /// Young's modulus E of the beam [Pa].
    pub young: f64,
    /// Its shear modulus G [Pa].
    pub shear_modulus: f64,
    /// σ_c: it breaks at this tension at its rim [Pa]; infinite: never.
    pub tensile_strength: f64,
    /// τ_c: it breaks at this shear [Pa]; infinite: never.
    pub shear_strength: f64,
    /// γ: dashpots are this share of √(k m*) of the stiffest motion of the two, in proportion to stiffness [–]; 0: none, 2: critical.
    pub damping: f64,
}

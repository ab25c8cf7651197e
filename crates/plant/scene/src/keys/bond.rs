//! Bonds between grains.

use super::table::{table, words};

/// Largest angle of friction: tan φ is finite [rad].
const STEEPEST: f64 = 1.55;

table! {
    /// `[[bond]]`
    Bond section {
        /// Materials of the two grains.
        between: [String; 2] = required, "", Any, "[\"rock\", \"rock\"]";
        /// What it resists; see above.
        kind: BondKind = absent("\"beam\""), "", Any, "\"parallel\"";
        /// Which grains, see [clusters](#clusters).
        clusters: Clusters = absent("\"same\""), "", Any, "\"any\"";
        /// Largest gap between the surfaces of two grains that is bonded.
        gap: f64 = required, "m", Within(0.0, 100.0), "1e-4";
        /// When the bonds are made.
        at: f64 = absent("0"), "s", FromZero, "0.1";
        /// Beam, parallel: r over the radius of the smaller grain.
        radius_ratio: Option<f64> = absent("1"), "", Positive, "1";
        /// Young's modulus E of a beam.
        young: Option<f64> = absent("required for beam"), "Pa", Positive, "1e9";
        /// Poisson's ratio of a beam.
        poisson: Option<f64> = absent("required for beam"), "", Poisson, "0.25";
        /// Parallel: k_n = E/(r_i + r_j) per area; contact: k_n = 2 E (r_i + r_j).
        modulus: Option<f64> = absent("–"), "Pa", Positive, "1e9";
        /// Normal over shear stiffness, k_n/k_s.
        stiffness_ratio: Option<f64> = absent("with `modulus`"), "", Positive, "2.5";
        /// Parallel: k_n, instead of `modulus`.
        normal_stiffness_per_area: Option<f64> = absent("–"), "Pa/m", Positive, "1e12";
        /// Parallel: k_s.
        shear_stiffness_per_area: Option<f64> = absent("–"), "Pa/m", Positive, "4e11";
        /// Contact: k_n, instead of `modulus`.
        normal_stiffness: Option<f64> = absent("–"), "N/m", Positive, "1e6";
        /// Contact: k_s.
        shear_stiffness: Option<f64> = absent("–"), "N/m", Positive, "4e5";
        /// Parallel: share β of the moments in the stress.
        moments: Option<f64> = absent("1"), "", Within(0.0, 1.0), "0.5";
        /// Tensile strength σ_c.
        tensile_strength: Option<f64> = absent("unbreakable"), "Pa", FromZero, "1e6";
        /// Shear strength τ_c.
        shear_strength: Option<f64> = absent("unbreakable"), "Pa", FromZero, "3e6";
        /// Contact: tensile strength as a force.
        tensile_force: Option<f64> = absent("–"), "N", FromZero, "10";
        /// Contact: shear strength as a force.
        shear_force: Option<f64> = absent("–"), "N", FromZero, "30";
        /// Tensile over shear strength, instead of one of them.
        strength_ratio: Option<f64> = absent("–"), "", Positive, "0.3";
        /// Angle of friction φ: pressure adds to the shear strength.
        friction_angle: Option<f64> = absent("0"), "rad", Within(0.0, STEEPEST), "\"30 deg\"";
        /// Standard deviation of the strengths over their mean (normal distribution).
        deviation: Option<f64> = absent("0"), "", Within(0.0, 1.0), "0.1";
        /// Exponent m of the strengths (Weibull distribution); the strengths are its scale: 63.2 % of the bonds are weaker.
        weibull_modulus: Option<f64> = absent("–"), "", Within(0.1, 1e4), "3";
        /// Radius r₀ of the bond that the strengths are of: bonds of another radius have (r₀/r)^(3/m) times the strength.
        reference_radius: Option<f64> = absent("no size effect"), "m", Positive, "0.01";
        /// Seed of the strengths.
        seed: Option<u64> = absent("0"), "", Any, "7";
        /// Share γ of critical damping, of dashpots beside the springs; 2 is critical damping.
        damping: Option<f64> = absent("0"), "", Within(0.0, 2.0), "0.1";
        /// Whether the two grains are not in contact besides, as long as the bond holds.
        replaces_contact: Option<bool> = absent("true for contact"), "", Any, "true";
    }
}

/// Keys of a `[[bond]]` of which either has its strengths drawn.
pub const DRAWN: [&str; 2] = ["deviation", "weibull_modulus"];

words! {
    /// What a bond resists.
    #[derive(Default)]
    BondKind {
        /// A beam from centre to centre.
        #[default]
        Beam "beam",
        /// Cement between the surfaces.
        Parallel "parallel",
        /// Glue at a point.
        Contact "contact",
    }
}

words! {
    /// Which grains are bonded, by their clusters.
    #[derive(Default)]
    Clusters {
        /// Of one cluster, or both of none.
        #[default]
        Same "same",
        /// Of two clusters.
        Different "different",
        /// All.
        Any "any",
    }
}

//! Grains from files, and what fills and insertions say of sizes.

use super::table::{table, words};

/// One diameter or a range [m].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OneOrRange {
    /// Smallest [m].
    pub low: f64,
    /// Largest [m].
    pub high: f64,
}

words! {
    /// What shares of sizes are of.
    #[derive(Default)]
    ShareOf {
        /// Of mass, as sieves tell.
        #[default]
        Mass "mass",
        /// Of number.
        Number "number",
    }
}

words! {
    /// Lattices of equal spheres that touch.
    Lattice {
        /// Six neighbours.
        Cubic "cubic",
        /// Twelve neighbours: layers of hexagons (hexagonal close packing).
        Hexagonal "hexagonal",
    }
}

table! {
    /// `[[particles]]`
    Particles section {
        /// CSV, PLY, or a run (its last frame).
        source: String = required, "", File, "\"grains.csv\"";
        /// Material of all grains; this or `materials`, unless the file is a run.
        material: Option<String> = absent("that of the run"), "", Any, "\"glass\"";
        /// Each row is a clump of this name.
        clump: Option<String> = absent("–"), "", Any, "\"stone\"";
        /// [Cluster](#clusters) of all grains.
        cluster: Option<u32> = absent("that of each row, or 0"), "", Any, "1";
        /// Instead of `material`: names for the numbers 0, 1, … in the column `material` of a CSV or PLY, as `stone-pack` writes it.
        materials: Option<Vec<String>> = absent("–"), "", Any, "[\"soil\", \"stone\"]";
        /// The grains stay where they are: they are spheres of a wall.
        fixed: bool = absent("false"), "", Any, "true";
        /// Unit of the lengths in the file (positions, radii, velocities): "µm", "mm", "cm", "m", "km", "in", "ft"; this or `scale`; not for a run, which is in
        /// metres.
        units: Option<String> = absent("\"m\""), "", Any, "\"mm\"";
        /// Factor on these lengths; this or `units`.
        scale: Option<f64> = absent("1"), "", Positive, "0.001";
    }
}

impl Particles {
    /// Factor on the lengths in its file [–].
    pub fn length_factor(&self) -> f64 {
        super::wall::length_factor(self.scale, self.units.as_deref())
    }
}

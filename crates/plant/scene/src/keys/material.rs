//! `[[material]]`.

use super::table::table;

table! {
    /// `[[material]]`
    Material section {
        /// Name.
        name: String = required, "", Name, "\"glass\"";
        /// Density; only grains need it.
        density: Option<f64> = absent("–"), "kg/m³", Positive, "2500";
        /// Young's modulus.
        young: f64 = required, "Pa", Positive, "1e7";
        /// Poisson's ratio.
        poisson: f64 = required, "", Poisson, "0.25";
    }
}

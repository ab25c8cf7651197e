//! How deep sliding wears a wall.
//!
//! ```text
//! V = K W        h = K W / A        h' = h / t        life = thickness / h'
//! ```
//!
//! K: worn volume per sliding work [m³/J]. J. F. Archard (1953), J. Appl. Phys. 24, DOI 10.1063/1.1721448, has the worn
//! volume k N s / H of a force N that slides a way s on a wall of hardness H; with the sliding work W = μ N s that is K = k/(μ H).

/// Seconds of 1000 hours.
const THOUSAND_HOURS: f64 = 3.6e6;

/// Seconds of an hour.
pub const HOURS: f64 = 3600.0;

/// Wear by sliding.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Archard {
    /// Worn volume per sliding work [m³/J].
    pub coefficient: f64,
}

impl Archard {
    /// Depth [m] by a sliding work per area [J/m²].
    pub fn depth(self, work_per_area: f64) -> f64 {
        self.coefficient * work_per_area
    }

    /// Depth of 1000 hours [m], where `depth` [m] took a time of this length [s].
    pub fn rate(depth: f64, length: f64) -> f64 {
        depth / length * THOUSAND_HOURS
    }

    /// Time [h] after which a `thickness` [m] is worn through; infinite where nothing wears.
    pub fn life(thickness: f64, depth: f64, length: f64) -> f64 {
        thickness / depth * length / HOURS
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_liner_lasts_as_long_as_its_thickness_over_its_rate() {
        // 2 kW/m² for 10 s.
        let depth = Archard { coefficient: 1e-13 }.depth(2e4);
        assert!((depth - 2e-9).abs() < 1e-21);
        let rate = Archard::rate(depth, 10.0);
        assert!((rate - 7.2e-4).abs() < 1e-15, "{rate}");
        let life = Archard::life(0.012, depth, 10.0);
        assert!((life * rate / 0.012 - 1000.0).abs() < 1e-9, "{life}");
        assert!(Archard::life(0.012, 0.0, 10.0).is_infinite());
    }
}

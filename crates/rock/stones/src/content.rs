//! The stop rule.
//!
//! ```text
//! excess = (V_r ρ_r − m p)/(m p)
//! ```
//!
//! V_r is the volume of all stones so far, ρ_r their density, m the total mass, p the wanted content. A stone that would make the excess larger than the
//! tolerance is not placed; stones are placed until the excess is not below minus the tolerance. A size class with the share s has s p instead of p
//! and its own stones in V_r.

/// How far a content is above the wanted one, over it [–]: volume of the stones [m³], their density [kg/m³], total mass [kg], wanted content [–].
pub fn excess(stones: f64, density: f64, mass: f64, content: f64) -> f64 {
    (stones * density - mass * content) / (mass * content)
}

/// The total mass at the end [kg], when stones have taken the place of soil: of soil so far [kg] and stones so far [m³], the density of the soil in bulk and
/// that of the stones [kg/m³], and the wanted content.
///
/// ```text
/// m = m_s + ρ_r V_r + (ρ_r − ρ_b) ΔV,   p m = ρ_r (V_r + ΔV)
/// m = (m_s + ρ_b V_r)/(1 − p (1 − ρ_b/ρ_r))
/// ```
pub fn final_mass(soil: f64, stones: f64, bulk: f64, density: f64, content: f64) -> f64 {
    (soil + bulk * stones) / (1.0 - content * (1.0 - bulk / density))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 2 m³ of stones of 2500 kg/m³ in 20 000 kg: 25 %. Wanted 20 %: a quarter too much; wanted 25 %: exact; wanted 50 %: half of it is missing.
    #[test]
    fn the_stop_rule_is_that_of_the_source() {
        assert_eq!(excess(2.0, 2500.0, 20_000.0, 0.2), 0.25);
        assert_eq!(excess(2.0, 2500.0, 20_000.0, 0.25), 0.0);
        assert_eq!(excess(2.0, 2500.0, 20_000.0, 0.5), -0.5);
        assert_eq!(excess(0.0, 2500.0, 20_000.0, 0.5), -1.0);
    }

    /// A box of 1 m³ of soil of 1600 kg/m³ in bulk: with 0.2 m³ of stones of 2600 kg/m³ it weighs 1280 + 520 kg.
    #[test]
    fn the_final_mass_is_the_same_from_any_point_on_the_way() {
        let content = 520.0 / 1800.0;
        for done in [0.0, 0.05, 0.2] {
            let found = final_mass(1600.0 * (1.0 - done), done, 1600.0, 2600.0, content);
            assert!((found - 1800.0).abs() < 1e-9, "{done}: {found}");
        }
    }
}

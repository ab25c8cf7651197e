//! The error of a run: energy that its finite time step created or removed, by the ledger.

use dem::Energy;
use serde::Serialize;
use std::fmt::{Display, Formatter, Result};

/// Share above which a warning is given [–].
const LARGE: f64 = 0.01;

/// Energy that the time step created (negative: removed).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct IntegrationError {
    /// In joules.
    pub energy: f64,
    /// Over the energy exchanged, or over the most of motion and springs in a frame where that is more [–].
    pub share: f64,
    /// Whether it is the share of the energy exchanged.
    pub of_exchanged: bool,
}

impl IntegrationError {
    /// That of a ledger; `None` where no energy was exchanged and nothing moved: no more than `rest`. `peak` is the most that moved or was in
    /// springs [J].
    pub fn of(energy: &Energy, peak: f64, rest: f64) -> Option<IntegrationError> {
        let (share, of_exchanged) = energy.error(peak, rest)?;
        Some(IntegrationError { energy: energy.integration, share, of_exchanged })
    }

    /// The line as a warning, where the error is large.
    pub fn warning(&self) -> Option<String> {
        let guard = if self.share > 0.0 { "; guards.energy stops such a run" } else { "" };
        let cure = format!("use a smaller time.safety or dt{guard}");
        (self.share.abs() > LARGE).then(|| format!("{self}: {cure}"))
    }
}

impl Display for IntegrationError {
    fn fmt(&self, f: &mut Formatter) -> Result {
        let (made, percent) = (geom::Shown(self.energy), geom::Shown(100.0 * self.share));
        let of =
            if self.of_exchanged { "the energy exchanged" } else { "the most energy of motion and springs" };
        write!(f, "integration error {percent} % of {of} ({made} J)")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_above_a_hundredth_is_a_warning() {
        let of = |integration| {
            let energy = Energy { normal: 2.0, translation: 1.0, integration, ..Energy::default() };
            IntegrationError::of(&energy, 0.5, 0.0).expect("something was exchanged")
        };
        let small = of(0.019);
        assert_eq!(small.to_string(), "integration error 0.95 % of the energy exchanged (0.019 J)");
        assert_eq!(small.warning(), None);
        let large = of(-0.021).warning().expect("a warning");
        assert!(
            large.starts_with("integration error -1.05 %") && large.ends_with("time.safety or dt"),
            "{large}"
        );
        assert!(of(0.021).warning().expect("a warning").contains("guards.energy"));
        assert_eq!(IntegrationError::of(&Energy::default(), 0.0, 0.0), None);
        let touching = Energy { elastic: 4e-31, integration: 5e-30, ..Energy::default() };
        assert_eq!(IntegrationError::of(&touching, 5e-30, 1e-20), None, "rounding of places");
        // All that moved has left the scene.
        let left = IntegrationError::of(&Energy { integration: 0.01, ..Energy::default() }, 2.0, 0.0)
            .expect("it moved");
        assert!(left.share == 0.005 && !left.of_exchanged, "{left:?}");
    }
}

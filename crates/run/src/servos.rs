//! How well servos held what they follow, at the end of a run.

use crate::frames::WallHead;
use dem::ServoReport;
use serde::Serialize;
use std::fmt::{Display, Formatter, Result};

/// Mean deviation above which a warning is given [–].
const LARGE: f64 = 0.01;
/// Share of steps at the speed limit above which a warning names it [–].
const LIMITED: f64 = 0.01;

/// How well one servo held its target.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ServoHeld {
    /// Name of its wall.
    pub wall: String,
    /// Force that is wanted at the end [N].
    pub target: f64,
    /// When it first reached its target to 1 % [s]; `None`: never.
    pub reached: Option<f64>,
    /// Mean |P − F| over mean F since then [–].
    pub mean_deviation: Option<f64>,
    /// Largest |P − F|/F since then [–].
    pub worst_deviation: Option<f64>,
    /// Share of the steps since then in which the wall moved at its speed limit [–].
    pub limited: f64,
    /// Whether it touched a particle.
    pub touched: bool,
}

impl ServoHeld {
    /// Those of all walls that have a servo.
    pub(crate) fn all(servos: &[(usize, ServoReport)], walls: &[WallHead]) -> Vec<ServoHeld> {
        let of = |(wall, servo): &(usize, ServoReport)| {
            let held = &servo.held;
            ServoHeld {
                wall: walls[*wall].name.clone(),
                target: servo.target,
                reached: held.since,
                mean_deviation: held.mean(),
                worst_deviation: held.mean().map(|_| held.worst),
                limited: held.limited as f64 / held.steps.max(1) as f64,
                touched: held.touched,
            }
        };
        servos.iter().map(of).collect()
    }

    /// The line as a warning, where the servo did not hold its target.
    pub fn warning(&self) -> Option<String> {
        let cure = match self.mean_deviation {
            _ if !self.touched && self.target > 0.0 => "start the wall nearer to the grains, or run longer",
            None if self.target > 0.0 => "run longer, or raise wall.servo.speed_limit",
            Some(mean) if mean > LARGE && self.limited > LIMITED => {
                "raise wall.servo.speed_limit, or drive the other walls more slowly"
            }
            Some(mean) if mean > LARGE => {
                "drive the other walls more slowly, or use a smaller time.safety or dt"
            }
            _ => return None,
        };
        Some(format!("{self}: {cure}"))
    }
}

impl Display for ServoHeld {
    fn fmt(&self, f: &mut Formatter) -> Result {
        write!(f, "servo of wall '{}': ", self.wall)?;
        let Some((since, mean)) = self.reached.zip(self.mean_deviation) else {
            return match (self.touched, self.target > 0.0) {
                (false, _) => write!(f, "touched no grain"),
                (true, true) => write!(f, "did not reach {} N", geom::Shown(self.target)),
                (true, false) => write!(f, "no force to hold"),
            };
        };
        let (worst, percent) = (self.worst_deviation.unwrap_or(0.0), |x: f64| geom::Shown(100.0 * x));
        write!(f, "force off by {} % in the mean, {} % at worst", percent(mean), percent(worst))?;
        write!(f, " since it was reached at {} s", geom::Shown(since))?;
        if self.limited > LIMITED {
            write!(f, ", {} % of the steps at the speed limit", percent(self.limited))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn held(mean: f64, limited: f64) -> ServoHeld {
        ServoHeld {
            wall: "lid".to_owned(),
            target: 10.0,
            reached: Some(0.5),
            mean_deviation: Some(mean),
            worst_deviation: Some(0.25),
            limited,
            touched: true,
        }
    }

    #[test]
    fn a_mean_above_a_hundredth_is_a_warning() {
        assert_eq!(held(0.009, 0.5).warning(), None);
        let line = held(0.009, 0.0).to_string();
        assert_eq!(
            line,
            "servo of wall 'lid': force off by 0.9 % in the mean, 25 % at worst since it was reached at 0.5 s"
        );
        let text = held(0.02, 0.0).warning().expect("a warning");
        assert!(text.contains("2 % in the mean") && text.contains("more slowly"), "{text}");
        let text = held(0.02, 0.5).warning().expect("a warning");
        assert!(
            text.contains("50 % of the steps at the speed limit")
                && text.contains("raise wall.servo.speed_limit"),
            "{text}"
        );
    }

    #[test]
    fn a_wall_that_touched_nothing_is_a_warning() {
        let away = ServoHeld { reached: None, mean_deviation: None, touched: false, ..held(0.0, 0.0) };
        let text = away.warning().expect("a warning");
        assert!(text.contains("'lid'") && text.contains("touched no grain"), "{text}");
        assert_eq!(ServoHeld { target: 0.0, ..away }.warning(), None);
    }
}

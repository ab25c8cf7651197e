//! How well servos held what they follow, at the end of a run.

use crate::frames::WallHead;
use dem::{Held, Simulation};
use serde::Serialize;
use std::fmt::{Display, Formatter, Result};

/// What the names of axes begin with.
const AXIS: &str = "domain.strain.";
/// Mean deviation above which a warning is given [–].
const LARGE: f64 = 0.01;
/// Share of steps at the speed limit above which a warning names it [–].
const LIMITED: f64 = 0.01;

/// How well one servo held its target, or one axis of the domain its stress.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ServoHeld {
    /// Name of its wall; `domain.strain.x` of an axis.
    pub wall: String,
    /// Unit of what it follows: N or Pa.
    pub unit: &'static str,
    /// Force or stress that is wanted at the end.
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
    /// Those of all walls that have a servo, and of axes that follow a stress.
    pub(crate) fn all(sim: &Simulation, walls: &[WallHead]) -> Vec<ServoHeld> {
        let of_walls = sim
            .servos()
            .into_iter()
            .map(|(wall, servo)| ServoHeld::new(walls[wall].name.clone(), "N", servo.target, &servo.held));
        let axes = ["x", "y", "z"].into_iter().zip(sim.followed_stresses());
        let of_axes = axes.filter_map(|(axis, followed)| {
            let (target, held) = followed?;
            Some(ServoHeld::new(format!("{AXIS}{axis}"), "Pa", target, &held))
        });
        of_walls.chain(of_axes).collect()
    }

    fn new(wall: String, unit: &'static str, target: f64, held: &Held) -> ServoHeld {
        ServoHeld {
            wall,
            unit,
            target,
            reached: held.since,
            mean_deviation: held.mean(),
            worst_deviation: held.mean().map(|_| held.worst),
            limited: held.limited as f64 / held.steps.max(1) as f64,
            touched: held.touched,
        }
    }

    /// Whether it is an axis of the domain.
    fn is_axis(&self) -> bool {
        self.wall.starts_with(AXIS)
    }

    /// The line as a warning, where the servo did not hold its target.
    pub fn warning(&self) -> Option<String> {
        let cure = match self.mean_deviation {
            None if self.is_axis() && self.target > 0.0 => "run longer, or raise its rate_limit",
            Some(mean) if self.is_axis() && mean > LARGE => {
                "strain the other axes more slowly, raise its rate_limit, or use a smaller time.safety or dt"
            }
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
        match self.is_axis() {
            true => write!(f, "{}: ", self.wall)?,
            false => write!(f, "servo of wall '{}': ", self.wall)?,
        }
        let what = if self.is_axis() { "stress" } else { "force" };
        let Some((since, mean)) = self.reached.zip(self.mean_deviation) else {
            return match (self.touched, self.target > 0.0) {
                (false, _) => write!(f, "touched no grain"),
                (true, true) => write!(f, "did not reach {} {}", geom::Shown(self.target), self.unit),
                (true, false) => write!(f, "no {what} to hold"),
            };
        };
        let (worst, percent) = (self.worst_deviation.unwrap_or(0.0), |x: f64| geom::Shown(100.0 * x));
        write!(f, "{what} off by {} % in the mean, {} % at worst", percent(mean), percent(worst))?;
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
            unit: "N",
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

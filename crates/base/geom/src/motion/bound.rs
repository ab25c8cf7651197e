//! How fast points of a wall can become, whenever that is.

use super::{Motion, Path};
use crate::Vec3;
use std::f64::consts::PI;

/// Share of a time by which it may be rounded: parts that meet for that long follow each other.
const ROUNDING: f64 = 1e-12;

/// How fast one part of a motion moves points at most.
struct Rates {
    /// Of all points alike [m/s].
    shifting: f64,
    /// About its axis [rad/s].
    turning: f64,
}

impl Motion {
    /// Upper bound of the speed [m/s] of points whose distance from a point of an axis is at most `span` of that point [m].
    ///
    /// Parts whose times do not meet do not add up. ∞ where a part carries the wall away from the axis of a later one for ever.
    pub fn fastest(&self, span: impl Fn(&Vec3) -> f64) -> f64 {
        let parts: Vec<(&Motion, f64)> =
            self.parts().enumerate().map(|(k, part)| (part, self.speed_of(k, part, &span))).collect();
        let (again, once): (Vec<_>, Vec<_>) =
            parts.into_iter().partition(|(part, _)| part.period.is_finite());
        let started = |part: &Motion| part.from * (1.0 + ROUNDING);
        let at_once = most(once.iter().map(|(part, _)| sum(&once, |other| other.runs_alone(started(part)))));
        let mut periods: Vec<f64> = again.iter().map(|(part, _)| part.period).collect();
        periods.sort_by(f64::total_cmp);
        periods.dedup();
        // Parts of one period meet in every one as they do in the first that all of them have.
        let of = |period: f64| {
            let alike: Vec<_> = again.iter().filter(|(part, _)| part.period == period).copied().collect();
            let later = |a: &Motion, b: &Motion| started(a) - b.from + ROUNDING * period;
            let meet = |a: &Motion, b: &Motion| b.runs_alone(b.from + later(a, b).rem_euclid(period));
            most(alike.iter().map(|(part, _)| sum(&alike, |other| meet(part, other))))
        };
        at_once + periods.into_iter().map(of).sum::<f64>()
    }

    /// Largest speed that its part `k` by itself gives any point [m/s].
    fn speed_of(&self, k: usize, part: &Motion, span: impl Fn(&Vec3) -> f64) -> f64 {
        let Rates { shifting, turning } = part.rates();
        if turning == 0.0 {
            return shifting;
        }
        let before = self.parts().take(k).filter(|m| m.from < part.ends());
        let carried: f64 = before.map(|m| m.way() + 2.0 * m.off_axis(&part.through)).sum();
        shifting + turning * (span(&part.through) + carried)
    }

    /// The time from which it does nothing any more [s].
    fn ends(&self) -> f64 {
        if self.period.is_finite() { f64::INFINITY } else { self.until }
    }

    fn rates(&self) -> Rates {
        let path = self.path.as_ref().map_or((0.0, 0.0), Path::fastest);
        let vibration = 2.0 * PI * self.frequency.abs() * self.amplitude.norm();
        let swing =
            if self.swings() { 2.0 * PI * self.swing_frequency.abs() * self.swing.norm() } else { 0.0 };
        Rates {
            shifting: self.velocity.norm() + vibration + path.0,
            turning: self.turn.norm() + swing + path.1,
        }
    }

    /// How far it shifts any point at most, beside its turning [m].
    fn way(&self) -> f64 {
        let open = self.ends() - self.from;
        let steady = if self.velocity == Vec3::zeros() { 0.0 } else { self.velocity.norm() * open };
        let leaves = |path: &Path| path.rows().last().is_some_and(|row| row.shift != Vec3::zeros());
        let path = match &self.path {
            Some(path) if self.period.is_finite() && leaves(path) => f64::INFINITY,
            path => path.as_ref().map_or(0.0, Path::farthest),
        };
        steady + self.amplitude.norm() + path
    }

    /// Distance of a point from the axis that it turns about [m]: half of the farthest that it takes this point by turning; 0 where it does not turn.
    fn off_axis(&self, point: &Vec3) -> f64 {
        let path = self.path.as_ref().map_or(Vec3::zeros(), Path::axis);
        let axes = [self.turn, self.swing, path].into_iter().filter_map(|axis| axis.try_normalize(0.0));
        let (from, axes) = (point - self.through, axes.collect::<Vec<_>>());
        let alike = axes.iter().all(|axis| axis.cross(&axes[0]) == Vec3::zeros());
        match axes.first() {
            None => 0.0,
            Some(axis) if alike => axis.cross(&from).norm(),
            Some(_) => from.norm(),
        }
    }
}

fn sum(parts: &[(&Motion, f64)], acts: impl Fn(&Motion) -> bool) -> f64 {
    parts.iter().filter(|(part, _)| acts(part)).map(|(_, speed)| speed).sum()
}

fn most(speeds: impl Iterator<Item = f64>) -> f64 {
    speeds.fold(0.0, f64::max)
}

//! Grains that run down a tilted wall of spheres, whichever way it is turned: does the wall lead them aside?
//!
//! The wall is turned under the tilt by an azimuth φ. A wall without preferred directions gives every φ the same speed down and no
//! drift aside except by random scatter; rows deflect grains along them and brake them across.
//!
//! ```text
//! V(φ) mean speed down, W(φ) mean speed aside             over the grains of one azimuth
//! unevenness   √(s²(V) − ⟨e²⟩)/⟨V⟩      deviation of V over φ, less what the errors e of the means make of it
//! drift        √(⟨W²⟩ − ⟨e²⟩)/⟨V⟩       the same of W about 0
//! ```
//!
//! A ball on a rough slope: Samson, Ippolito, Batrouni & Lemaitre (1998), Eur. Phys. J. B 3, doi:10.1007/s100510050327.

use super::chance::{Chance, Mean, mean};
use super::plates::{still, touch};
use dem::Simulation;
use dem::setup::*;
use geom::Vec3;
use grainpipe_tests::setups::{Law, empty, grain};
use rayon::prelude::*;

/// How grains run.
#[derive(Debug, Clone, Copy)]
pub struct Slope {
    /// Tilt [rad].
    pub tilt: f64,
    /// Radius of the grains [m].
    pub radius: f64,
    /// μ [–].
    pub friction: f64,
    /// e [–].
    pub restitution: f64,
    /// How long they run [s].
    pub time: f64,
    /// Grains of each azimuth: that many squared.
    pub side: usize,
    /// Their distance at the start [m].
    pub apart: f64,
}

/// Speeds of one azimuth [m/s].
#[derive(Debug, Clone)]
pub struct Run {
    /// φ [rad].
    pub azimuth: f64,
    /// Of each grain, down the slope.
    pub down: Vec<f64>,
    /// Of each grain, aside.
    pub aside: Vec<f64>,
}

/// Grains of several azimuths on a wall whose middle is the origin.
pub fn runs(spheres: &[(Vec3, f64)], slope: Slope, azimuths: &[f64]) -> Vec<Run> {
    azimuths.par_iter().map(|&azimuth| run(spheres, slope, azimuth)).collect()
}

fn run(spheres: &[(Vec3, f64)], slope: Slope, azimuth: f64) -> Run {
    let mut setup = empty(Law::Hooke { stiffness: 2e3, tangential_ratio: None }, slope.restitution);
    setup.contacts.iter_mut().for_each(|c| c.set("sliding_friction", slope.friction));
    let (sin, cos) = slope.tilt.sin_cos();
    let (down, aside) =
        (Vec3::new(azimuth.cos(), azimuth.sin(), 0.0), Vec3::new(-azimuth.sin(), azimuth.cos(), 0.0));
    setup.gravity = 9.81 * (down * sin - Vec3::z() * cos);
    setup.walls = vec![still(spheres)];
    setup.step = Step::Auto(0.4);
    let mut chance = Chance::new(5);
    let at = |n: usize| slope.apart * (n as f64 - 0.5 * (slope.side as f64 - 1.0));
    for k in 0..slope.side * slope.side {
        let jitter = 0.25 * slope.apart;
        let x = at(k % slope.side) + chance.between(-jitter, jitter);
        let y = at(k / slope.side) + chance.between(-jitter, jitter);
        let (z, _) = touch(spheres, slope.radius, x, y).expect("on the wall");
        let from = Vec3::new(x, y, z + 0.1 * slope.radius);
        setup.particles.push(Particle { radius: slope.radius, ..grain(k as u32, from) });
    }
    let start: Vec<Vec3> = setup.particles.iter().map(|p| p.position).collect();
    let mut sim = Simulation::new(setup).expect("sound");
    while sim.time() < slope.time {
        sim.step().expect("no guard");
    }
    let ways: Vec<Vec3> =
        sim.particles().expect("no guard").iter().zip(&start).map(|(p, from)| p.position - from).collect();
    let along = |to: Vec3| ways.iter().map(|w| w.dot(&to) / slope.time).collect();
    Run { azimuth, down: along(down), aside: along(aside) }
}

/// What a wall does to the direction of flow [–], each with half the width of its 95 % interval.
#[derive(Debug, Clone, Copy)]
pub struct Anisotropy {
    /// Mean speed down [m/s].
    pub speed: Mean,
    /// Deviation of the mean downward speed over the azimuths, minus random scatter, over the mean speed.
    pub unevenness: Mean,
    /// Root mean square of the mean sideways speed, minus random scatter, over the mean downward speed.
    pub drift: Mean,
}

/// Measures of runs of several azimuths. Intervals: grains resampled with replacement (Efron 1979,
/// doi:10.1214/aos/1176344552), `draws` times.
pub fn anisotropy(runs: &[Run], draws: usize) -> Anisotropy {
    let all: Vec<f64> = runs.iter().flat_map(|r| r.down.iter().copied()).collect();
    let (unevenness, drift) = indices(runs);
    let mut chance = Chance::new(11);
    let drawn: Vec<(f64, f64)> = (0..draws).map(|_| indices(&again(runs, &mut chance))).collect();
    let spread = |value: f64, of: &dyn Fn(&(f64, f64)) -> f64| {
        let deviation = mean(&drawn.iter().map(of).collect::<Vec<f64>>()).deviation;
        Mean { mean: value, off: 1.96 * deviation, deviation }
    };
    Anisotropy { speed: mean(&all), unevenness: spread(unevenness, &|d| d.0), drift: spread(drift, &|d| d.1) }
}

/// Square of the drift [–] of walls that are alike, the mean over them; the interval is that of the walls.
pub fn squared_drift(walls: &[Vec<Run>]) -> Mean {
    mean(&walls.iter().map(|runs| squares(runs).1).collect::<Vec<f64>>())
}

/// Unevenness and drift; 0 where chance explains more than there is.
fn indices(runs: &[Run]) -> (f64, f64) {
    let (unevenness, drift) = squares(runs);
    (unevenness.max(0.0).sqrt(), drift.max(0.0).sqrt())
}

/// Squares of unevenness and drift; negative where chance explains more than there is.
fn squares(runs: &[Run]) -> (f64, f64) {
    let down: Vec<Mean> = runs.iter().map(|r| mean(&r.down)).collect();
    let aside: Vec<Mean> = runs.iter().map(|r| mean(&r.aside)).collect();
    let error = |of: &[Mean]| mean(&of.iter().map(|m| (m.off / 1.96).powi(2)).collect::<Vec<f64>>()).mean;
    let speeds = mean(&down.iter().map(|m| m.mean).collect::<Vec<f64>>());
    let squares = mean(&aside.iter().map(|m| m.mean.powi(2)).collect::<Vec<f64>>()).mean;
    let share = |square: f64| square / speeds.mean.powi(2);
    (share(speeds.deviation.powi(2) - error(&down)), share(squares - error(&aside)))
}

/// The same number of grains, drawn from those there are.
fn again(runs: &[Run], chance: &mut Chance) -> Vec<Run> {
    let one = |run: &Run, chance: &mut Chance| {
        let n = run.down.len();
        let picks: Vec<usize> = (0..n).map(|_| ((chance.share() * n as f64) as usize).min(n - 1)).collect();
        let of = |values: &[f64]| picks.iter().map(|&k| values[k]).collect();
        Run { azimuth: run.azimuth, down: of(&run.down), aside: of(&run.aside) }
    };
    runs.iter().map(|r| one(r, chance)).collect()
}

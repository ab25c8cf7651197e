//! What a run holds over time, at a glance: kinetic energy, mass, forces on walls, what left through outlets, bonds.
//!
//! Everything that costs no more than to read the run. Curves of many points are thinned.

use crate::bonds::BondNumbers;
use crate::energy::Energy;
use crate::observer::Observer;
use crate::sheet::{CURVES, Curve, Look, Panel, Row};
use crate::{Crossing, Frame, Run, RunMessage, WallForces};

/// Most points of a curve.
const POINTS: usize = 500;

/// Most terms of the energy ledger that are shown.
const TERMS: usize = 6;

/// Reads a run for its curves.
#[derive(Default)]
pub struct Overview {
    energy: (Energy, Vec<Row>),
    bonds: (BondNumbers, Vec<Row>),
    /// Time [s], kinetic energy of translation [J], mass [kg].
    grains: Vec<[f64; 3]>,
    /// Name of each wall, with time [s] and size of the force [N].
    walls: Vec<(String, Vec<[f64; 2]>)>,
    /// Of each outlet, time [s] and mass that has passed [kg].
    outlets: Vec<Vec<[f64; 2]>>,
}

impl Overview {
    /// Takes a message of a run; what cannot be measured is left out.
    pub fn take(&mut self, run: &Run, message: RunMessage) {
        match &message {
            RunMessage::Frame(frame) => self.frame(frame),
            RunMessage::WallForces(forces) => return self.wall_forces(forces),
            RunMessage::Crossings(crossings) => return self.crossings(crossings),
            RunMessage::Ledger(_) => {
                let _ = self.energy.0.observe(run, message, &mut self.energy.1);
                return;
            }
            RunMessage::Bonds(_) | RunMessage::Cracks(_) => {}
            RunMessage::Contacts(_)
            | RunMessage::Settled(_)
            | RunMessage::Domain(_)
            | RunMessage::WallWear(_) => return,
        }
        let _ = self.bonds.0.observe(run, message, &mut self.bonds.1);
    }

    fn frame(&mut self, frame: &Frame) {
        // A clump is one grain: what it turns with has no part in this energy, as with any grain.
        let frame = frame.grains();
        let Ok(masses) = frame.masses() else { return };
        let energy = masses.iter().zip(&frame.velocity).map(|(m, v)| 0.5 * m * v.norm_squared()).sum();
        self.grains.push([frame.time, energy, masses.iter().sum()]);
    }

    fn wall_forces(&mut self, forces: &WallForces) {
        for (k, wall) in forces.walls.iter().take(CURVES).enumerate() {
            if self.walls.len() <= k {
                self.walls.push((wall.name.clone(), Vec::new()));
            }
            let force = wall.means.map_or(wall.force, |means| means.force);
            self.walls[k].1.push([forces.time, force.norm()]);
        }
    }

    fn crossings(&mut self, crossings: &[Crossing]) {
        for crossing in crossings.iter().filter(|c| c.outlet < CURVES && c.mass.is_finite()) {
            if self.outlets.len() <= crossing.outlet {
                self.outlets.resize(crossing.outlet + 1, Vec::new());
            }
            let passed = &mut self.outlets[crossing.outlet];
            let before = passed.last().map_or(0.0, |p| p[1]);
            passed.push([crossing.time, before + crossing.mass]);
        }
    }

    /// The curves; of what does not change there are none.
    pub fn panels(&self) -> Vec<Panel> {
        let mut panels = Vec::new();
        let mut add = |y: &str, curves: Vec<Curve>| {
            if curves.iter().any(changes) {
                panels.push(Panel::Curves { x: "time [s]".to_owned(), y: y.to_owned(), curves });
            }
        };
        let grains = |k: usize| self.grains.iter().map(|row| [row[0], row[k]]).collect::<Vec<_>>();
        match self.energy.0.chart(&self.energy.1).panels.into_iter().next() {
            Some(Panel::Curves { y, curves, .. }) if !self.energy.1.is_empty() => {
                add(&y, largest(curves).into_iter().map(|c| curve(&c.name, c.points)).collect());
            }
            _ => add("kinetic energy [J]", vec![curve("", grains(1))]),
        }
        add("mass of the grains [kg]", vec![curve("", grains(2))]);
        let passed = self.outlets.iter().enumerate().filter(|(_, points)| !points.is_empty());
        add("mass that left [kg]", passed.map(|(k, p)| curve(&format!("outlet {k}"), p.clone())).collect());
        add("force on walls [N]", self.walls.iter().map(|(name, p)| curve(name, p.clone())).collect());
        if !self.bonds.1.is_empty() {
            for panel in self.bonds.0.chart(&self.bonds.1).panels {
                if let Panel::Curves { y, curves, .. } = panel {
                    add(&y, curves.into_iter().map(|c| curve(&c.name, c.points)).collect());
                }
            }
        }
        panels
    }
}

/// The few curves that change most, in their order.
fn largest(curves: Vec<Curve>) -> Vec<Curve> {
    let change = |c: &Curve| {
        let values = || c.points.iter().map(|p| p[1]);
        values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
    };
    let mut all: Vec<f64> = curves.iter().map(change).filter(|c| c.is_finite()).collect();
    all.sort_by(|a, b| b.total_cmp(a));
    // What is a thousandth of the largest is a line on the axis.
    let least = all.get(TERMS - 1).copied().unwrap_or(0.0).max(1e-3 * all.first().copied().unwrap_or(0.0));
    curves.into_iter().filter(|c| change(c) >= least).take(TERMS).collect()
}

/// Whether it has two values at least.
fn changes(curve: &Curve) -> bool {
    let first = curve.points.first().map_or(0.0, |p| p[1]);
    curve.points.iter().any(|p| p[1] != first)
}

/// A line, of a few points.
fn curve(name: &str, points: Vec<[f64; 2]>) -> Curve {
    let (count, step) = (points.len(), points.len().div_ceil(POINTS).max(1));
    let kept = points.into_iter().enumerate().filter(|(k, _)| k % step == 0 || k + 1 == count);
    Curve { name: name.to_owned(), points: kept.map(|(_, p)| p).collect(), look: Look::Line }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ForceOnWall;
    use geom::Vec3;

    fn labels(overview: &Overview) -> Vec<String> {
        let label = |panel: Panel| match panel {
            Panel::Curves { y, .. } | Panel::Map { y, .. } => y,
        };
        overview.panels().into_iter().map(label).collect()
    }

    #[test]
    fn of_many_curves_those_that_change_most_stay_in_their_order() {
        let all = (0..9).map(|k| curve(&k.to_string(), vec![[0.0, 0.0], [1.0, f64::from((k * 5) % 9)]]));
        let names: Vec<String> = largest(all.collect()).into_iter().map(|c| c.name).collect();
        assert_eq!(names, ["1", "3", "5", "6", "7", "8"], "of 0 5 1 6 2 7 3 8 4");
        let tiny = vec![curve("a", vec![[0.0, 0.0], [1.0, 1e4]]), curve("b", vec![[0.0, 0.0], [1.0, 1.0]])];
        assert_eq!(largest(tiny).len(), 1);
    }

    #[test]
    fn what_changes_has_a_curve_and_what_does_not_has_none() {
        let (mut overview, run) = (Overview::default(), Run::default());
        assert!(labels(&overview).is_empty());
        for k in 0..1200 {
            let time = f64::from(k);
            let frame = Frame {
                time,
                id: vec![0],
                position: vec![Vec3::zeros()],
                velocity: vec![Vec3::new(0.0, 0.0, time)],
                radius: vec![1.0],
                material: vec![0],
                mass: vec![2.0],
                ..Frame::default()
            };
            overview.take(&run, RunMessage::Frame(frame));
            let wall = |f: f64| ForceOnWall {
                name: "lid".into(),
                force: Vec3::new(0.0, f, 0.0),
                contacts: 1,
                shift: None,
                means: None,
            };
            let forces = WallForces { time, interval: None, walls: vec![wall(-3.0 * time)] };
            overview.take(&run, RunMessage::WallForces(forces));
        }
        // The mass is the same all the time.
        assert_eq!(labels(&overview), ["kinetic energy [J]", "force on walls [N]"]);
        let Some(Panel::Curves { curves, .. }) = overview.panels().into_iter().next() else {
            panic!("curves")
        };
        assert!(curves[0].points.len() <= POINTS + 1, "{}", curves[0].points.len());
        assert_eq!(curves[0].points.last(), Some(&[1199.0, 1199.0 * 1199.0]));
    }
}

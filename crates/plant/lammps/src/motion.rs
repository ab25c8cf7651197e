//! Motions of walls as formulas of LAMMPS.
//!
//! ```text
//! shift   v p + a sin(2π f p)                    p: 0 until `from`, then t − from, constant from `until` on
//! turn    Ω t about an axis through a point      one steady turn, from the start on, and nothing else
//! ```
//!
//! The velocity of a region is the difference of two of its positions over a step; that of atoms is given exactly.

use crate::error::Refusal;
use dem::setup::{Motion, Wall};
use geom::{Plane, Vec3};

/// What LAMMPS can do of a motion.
#[derive(Debug, Clone, PartialEq)]
pub enum Movement {
    /// At rest.
    Still,
    /// Shift along x, y, z [m], and velocity [m/s], as formulas of `v_t`.
    Shift {
        /// Displacement [m].
        by: [String; 3],
        /// Its derivative [m/s].
        velocity: [String; 3],
    },
    /// Ω, axis times rate [rad/s], about an axis through a point [m].
    Turn {
        /// Ω [rad/s].
        rate: Vec3,
        /// A point of the axis [m].
        through: Vec3,
    },
}

impl Movement {
    /// That of a plane: a belt moves along itself, which leaves an unbounded plane where it is.
    ///
    /// # Errors
    /// As [`Movement::of`]; a surface that turns.
    pub fn of_plane(wall: &Wall, plane: &Plane) -> Result<Movement, Refusal> {
        if !wall.surface.moves() {
            return Movement::of(&wall.name, &wall.motion);
        }
        let refuse =
            |why: &str, nearest: &str| Err(Refusal::new(format!("wall '{}'", wall.name), why, nearest));
        if wall.surface.turn != Vec3::zeros() {
            return refuse("LAMMPS has no turntables", "use wall spheres with motion rotate, or dem-run");
        }
        if wall.motion.moves() {
            return refuse("a belt that moves besides is not written for LAMMPS", "leave its motion out");
        }
        let across = wall.surface.velocity.dot(&plane.normal);
        let velocity = wall.surface.velocity - plane.normal * across;
        Ok(shift(&[&Motion { velocity, ..Motion::default() }]))
    }

    /// That of a motion; `name` is the wall's.
    ///
    /// # Errors
    /// Motions that LAMMPS has no command for.
    pub fn of(name: &str, motion: &Motion) -> Result<Movement, Refusal> {
        let refuse =
            |why: &str, nearest: &str| Err(Refusal::new(format!("wall '{name}'.motion"), why, nearest));
        if !motion.moves() {
            return Ok(Movement::Still);
        }
        let parts: Vec<&Motion> = motion.parts().collect();
        if parts.iter().any(|m| m.swing_frequency != 0.0 || m.path.is_some()) {
            return refuse("swing and path are not written for LAMMPS", "use translate, vibrate or rotate");
        }
        if parts.iter().any(|m| m.ramp != 0.0) {
            return refuse("ramp is not written for LAMMPS", "leave ramp out");
        }
        if parts.iter().any(|m| m.period.is_finite()) {
            return refuse(
                "repeat is not written for LAMMPS",
                "write each of its times as a motion of a list",
            );
        }
        let turns = parts.iter().any(|m| m.turn != Vec3::zeros());
        match &parts[..] {
            [m] if turns => match (m.from, m.until, m.velocity == Vec3::zeros() && m.frequency == 0.0) {
                (0.0, f64::INFINITY, true) => Ok(Movement::Turn { rate: m.turn, through: m.through }),
                _ => refuse(
                    "LAMMPS turns a wall from the start to the end, and does not move it besides",
                    "leave from, until, translate and vibrate out",
                ),
            },
            _ if turns => refuse("LAMMPS does not compose a turn with other motions", "give one motion"),
            _ => Ok(shift(&parts)),
        }
    }
}

/// p of a motion as a formula.
fn progress(m: &Motion) -> String {
    let end = match m.until.is_finite() {
        true => format!("((v_t<{0:?})*v_t+(v_t>={0:?})*{0:?})", m.until),
        false => "v_t".to_owned(),
    };
    match m.from > 0.0 {
        true => format!("((v_t>{0:?})*({end}-{0:?}))", m.from),
        false => end,
    }
}

/// 1 while a motion runs, else 0.
fn runs(m: &Motion) -> String {
    let end = if m.until.is_finite() { format!("*(v_t<{:?})", m.until) } else { String::new() };
    let start = if m.from > 0.0 { format!("*(v_t>={:?})", m.from) } else { String::new() };
    format!("{start}{end}")
}

fn shift(parts: &[&Motion]) -> Movement {
    let (mut by, mut velocity) = (Vec::new(), Vec::new());
    for axis in 0..3 {
        let (mut places, mut speeds) = (Vec::new(), Vec::new());
        for m in parts {
            let (p, runs) = (progress(m), runs(m));
            let (v, a, w) = (m.velocity[axis], m.amplitude[axis], std::f64::consts::TAU * m.frequency);
            if v != 0.0 {
                places.push(format!("{v:?}*{p}"));
                speeds.push(format!("{v:?}{runs}"));
            }
            if a != 0.0 && w != 0.0 {
                places.push(format!("{a:?}*sin({w:?}*{p})"));
                speeds.push(format!("{:?}*cos({w:?}*{p}){runs}", a * w));
            }
        }
        let sum = |terms: Vec<String>| if terms.is_empty() { "0.0".to_owned() } else { terms.join("+") };
        by.push(sum(places));
        velocity.push(sum(speeds));
    }
    let three = |list: Vec<String>| std::array::from_fn(|axis| list[axis].clone());
    Movement::Shift { by: three(by), velocity: three(velocity) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gate_that_opens_and_closes_is_a_formula() {
        let up = Motion { velocity: Vec3::z(), from: 1.0, until: 2.0, ..Motion::default() };
        let down = Motion { velocity: -Vec3::z(), from: 3.0, until: 4.0, ..Motion::default() };
        let motion = Motion::of(vec![up, down]);
        let Ok(Movement::Shift { by, velocity }) = Movement::of("gate", &motion) else { panic!() };
        assert_eq!(by[0], "0.0");
        assert_eq!(
            by[2],
            "1.0*((v_t>1.0)*(((v_t<2.0)*v_t+(v_t>=2.0)*2.0)-1.0))+-1.0*((v_t>3.0)*(((v_t<4.0)*v_t+(v_t>=4.0)*4.0)-3.0))"
        );
        assert_eq!(velocity[2], "1.0*(v_t>=1.0)*(v_t<2.0)+-1.0*(v_t>=3.0)*(v_t<4.0)");
    }

    #[test]
    fn what_lammps_cannot_is_refused_by_name() {
        let swing = Motion { swing: Vec3::y(), swing_frequency: 3.0, ..Motion::default() };
        let refused = Movement::of("gate", &swing).unwrap_err();
        assert!(refused.to_string().starts_with("wall 'gate'.motion: swing"));
    }
}

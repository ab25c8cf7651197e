//! Impacts: duration, deepest overlap and restitution of a contact.
//!
//! ```text
//! δ(t) = δ_k − n·(u(t) − u_k)      u = x_i − x_j (of a wall at rest, x_i); δ_k the recorded overlap, n its normal
//! ```
//!
//! follows the overlap also into the frame before the contact and the frame after it, where nothing was recorded. Between
//! frames δ is the cubic with the overlaps and speeds of both (see [`crate::path`]): its zeros are the start and the end,
//! its highest point is the deepest overlap. Speeds along the normal are those of the last frame before and the first
//! after the two act on each other, without what gravity adds between that frame and the contact. Frames must be much closer than
//! the contact lasts: `[output] every = "step"` writes one at every step. A wall is taken to be at rest.

use crate::definition::{AskError, Asked, Figure, Frames, Measure, number};
use crate::geometry::cubic::Cubic;
use crate::observer::{NO_CONTACTS, Observer};
use crate::sheet::{Chart, Curve, Head, Look, Row, Summary};
use crate::statistics::Mean;
use crate::{Contact, Frame, MeasureError, Partner, Run, RunMessage};
use geom::{Vec3, counted};
use std::collections::{BTreeMap, HashMap};

/// Two that touch: grain i, and j, and whether j is a wall.
type Pair = (u64, u64, bool);

/// A contact that goes on.
#[derive(Debug, Clone, Copy)]
struct OpenContact {
    /// Speed before [m/s]; `None` when that was not seen.
    before: Option<f64>,
    /// When it began [s]; `None` when that was not seen, or has yet to come.
    start: Option<f64>,
    /// When it ended [s], where the force outlasts that.
    end: Option<f64>,
    deepest: f64,
    overlap: f64,
    normal: Vec3,
    /// Frames in which it was seen.
    frames: u64,
}

/// Frames that a contact should be seen in, unless one is written at every step.
const FRAMES: u64 = 5;

/// Positions and velocities at one time, by id.
#[derive(Debug, Default)]
struct Moment {
    time: f64,
    states: HashMap<u64, (Vec3, Vec3)>,
}

impl Moment {
    fn of(frame: &Frame) -> Moment {
        let states = frame.position.iter().copied().zip(frame.velocity.iter().copied());
        Moment { time: frame.time, states: frame.id.iter().copied().zip(states).collect() }
    }

    /// Position and velocity of i relative to j.
    fn between(&self, run: &Run, pair: Pair) -> Option<(Vec3, Vec3)> {
        let (x, v) = *self.states.get(&pair.0)?;
        if pair.2 {
            return Some((x, v));
        }
        let (y, w) = *self.states.get(&pair.1)?;
        Some((run.periodic.way(&y, &x), v - w))
    }
}

/// Watches contacts begin and end.
pub struct Impacts {
    between: (f64, f64),
    /// The frame before, and that of the contacts that come next.
    moments: [Option<Moment>; 2],
    open: BTreeMap<Pair, OpenContact>,
    rows: [Vec<f64>; 3],
    contact_frames: u64,
    /// Contacts whose start or end was not seen.
    cut: u64,
    /// Contacts that few frames show.
    coarse: u64,
}

impl Impacts {
    /// Nothing seen yet; impacts that begin between two times [s] count.
    pub fn new(between: (f64, f64)) -> Impacts {
        Impacts {
            between,
            moments: [None, None],
            open: BTreeMap::new(),
            rows: Default::default(),
            contact_frames: 0,
            cut: 0,
            coarse: 0,
        }
    }

    /// The overlap of a pair between the frame before and now, where it is or was `overlap` at one of them.
    fn cubic(&self, run: &Run, pair: Pair, overlap: f64, now: bool, normal: &Vec3) -> Option<Cubic> {
        let [before, after] = &self.moments;
        let (before, after) = (before.as_ref()?, after.as_ref()?);
        let (a, b) = (before.between(run, pair)?, after.between(run, pair)?);
        let grown = -run.periodic.way(&a.0, &b.0).dot(normal);
        let ends = if now { [overlap - grown, overlap] } else { [overlap, overlap + grown] };
        let h = after.time - before.time;
        let ways = [-a.1.dot(normal) * h, -b.1.dot(normal) * h];
        Some(Cubic { times: [before.time, after.time], ends, ways })
    }

    /// A pair that acts on each other now: it may do so shortly before it touches, and after.
    fn touches(&mut self, run: &Run, pair: Pair, contact: &Contact) {
        let old = self.open.get(&pair).copied();
        let cubic = self.cubic(run, pair, contact.overlap, true, &contact.normal);
        let (overlap, normal) = (contact.overlap, contact.normal);
        let mut open = old.unwrap_or(OpenContact {
            before: None,
            start: None,
            end: None,
            deepest: 0.0,
            overlap,
            normal,
            frames: 0,
        });
        open.frames += 1;
        if let Some(cubic) = cubic {
            let speed = cubic.ways[0] / (cubic.times[1] - cubic.times[0]);
            open.before = open.before.or(old.is_none().then_some(speed));
            let [before, now] = cubic.ends.map(|overlap| overlap > 0.0);
            open.start = open.start.or((!before && now).then(|| cubic.zero()));
            open.end = if before && !now { Some(cubic.zero()) } else { open.end.filter(|_| !now) };
            open.deepest = open.deepest.max(cubic.highest());
        }
        (open.overlap, open.normal) = (overlap, normal);
        open.deepest = open.deepest.max(overlap);
        self.open.insert(pair, open);
    }

    /// A pair that acted on each other and does not now: its row, when all of the impact was seen.
    fn parted(&mut self, run: &Run, pair: Pair, open: &OpenContact) -> Option<Row> {
        let cubic = self.cubic(run, pair, open.overlap, false, &open.normal);
        let Some(((start, before), cubic)) = open.start.zip(open.before).zip(cubic) else {
            // Surfaces that never met had no impact.
            self.cut += u64::from(open.deepest > 0.0);
            return None;
        };
        if !run.is_between(self.between, start) {
            return None;
        }
        let after = -cubic.ways[1] / (cubic.times[1] - cubic.times[0]);
        let lasted = open.end.unwrap_or_else(|| cubic.zero()) - start;
        let deepest = open.deepest.max(cubic.highest());
        let restitution = after / before;
        if !(restitution > 0.0) {
            // They still come closer: between these frames more has happened.
            self.cut += 1;
            return None;
        }
        let apart = cubic.times[1] - cubic.times[0];
        self.coarse += u64::from(open.frames < FRAMES && apart > 1.5 * run.step);
        for (list, value) in self.rows.iter_mut().zip([lasted, deepest, restitution]) {
            list.push(value);
        }
        let wall = f64::from(u8::from(pair.2));
        Some(vec![start, lasted, deepest, before, after, restitution, pair.0 as f64, pair.1 as f64, wall])
    }
}

impl Observer for Impacts {
    fn heads(&self) -> Vec<Head> {
        Head::list(&[
            ("time", "s"),
            ("contact_time", "s"),
            ("overlap", "m"),
            ("speed_before", "m/s"),
            ("speed_after", "m/s"),
            ("restitution", "1"),
            ("id_i", "1"),
            ("id_j", "1"),
            ("kind", "1"),
        ])
    }

    fn observe(&mut self, run: &Run, message: RunMessage, rows: &mut Vec<Row>) -> Result<(), MeasureError> {
        let contacts = match message {
            RunMessage::Frame(frame) => {
                self.moments = [self.moments[1].take(), Some(Moment::of(&frame))];
                return Ok(());
            }
            RunMessage::Contacts(contacts) => contacts,
            _ => return Ok(()),
        };
        self.contact_frames += 1;
        let mut now: BTreeMap<Pair, &Contact> = BTreeMap::new();
        for contact in &contacts.rows {
            let pair = match contact.partner {
                Partner::Grain(j) => (contact.grain, j, false),
                Partner::Wall(j) => (contact.grain, j, true),
            };
            // A grain may touch a wall of spheres or a mesh in several places: the deepest counts.
            let deepest = now.entry(pair).or_insert(contact);
            if contact.overlap > deepest.overlap {
                *deepest = contact;
            }
        }
        let over: Vec<(Pair, OpenContact)> =
            self.open.iter().filter(|(pair, _)| !now.contains_key(pair)).map(|(p, o)| (*p, *o)).collect();
        for (pair, open) in over {
            self.open.remove(&pair);
            rows.extend(self.parted(run, pair, &open));
        }
        for (pair, contact) in now {
            self.touches(run, pair, contact);
        }
        Ok(())
    }

    fn end(&mut self, _: &Run, _: &mut Vec<Row>) -> Result<Summary, MeasureError> {
        if self.contact_frames == 0 {
            return Err(NO_CONTACTS);
        }
        if self.rows[0].is_empty() {
            let cure = "write frames during the contact ([output] every = \"step\"), and run until the contact has ended";
            return Err(MeasureError::Channel {
                topic: record::topic::CONTACTS,
                what: "impact that begins and ends",
                cure,
            });
        }
        let [time, overlap, restitution] = [0, 1, 2].map(|k| Mean::of(&self.rows[k]).mean);
        let summary = Summary::default()
            .with("contact_time", "s", time)
            .with("overlap", "m", overlap)
            .with("restitution", "1", restitution)
            .with("largest_overlap", "m", self.rows[1].iter().copied().fold(0.0, f64::max))
            .with("impacts", "1", self.rows[0].len() as f64);
        let coarse = format!(
            "{} of these lasted fewer than {FRAMES} frames, so the numbers are rough: write more, at best [output] every = \"step\"",
            self.coarse
        );
        let summary = if self.coarse > 0 { summary.note(coarse) } else { summary };
        let cut = self.cut + self.open.len() as u64;
        let left_out = counted(cut, "contact");
        let note =
            format!("left out {left_out} that began before the first frame or had not ended by the last");
        Ok(if cut > 0 { summary.note(note) } else { summary })
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        let dots = |k: usize| {
            let points = rows.iter().map(|r| [r[0], r[k]]).collect();
            vec![Curve { name: String::new(), points, look: Look::Dots }]
        };
        Chart::new("Impacts").curves("time [s]", "restitution [1]", dots(5)).curves(
            "time [s]",
            "contact time [s]",
            dots(1),
        )
    }
}

impl Measure for Impacts {
    const NAME: &'static str = "impact";
    const HELP: &'static str = "Impacts: contact time, deepest overlap, restitution";
    const FRAMES: Frames = Frames::Events;
    const FIGURES: &'static [Figure] = &[
        number("contact-time", "contact_time"),
        number("overlap", "overlap"),
        number("restitution", "restitution"),
    ];

    fn observer(asked: &Asked) -> Result<Box<dyn Observer>, AskError> {
        Ok(Box::new(Impacts::new(asked.between)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Contacts;

    /// A grain on a floor at z = 0 that follows a damped sine for half a period, δ = v/ω e^(−γt) sin ωt, in frames that do not
    /// hit its ends: it parts at e = e^(−γπ/ω) of its speed, and is deepest at tan ωt = ω/γ.
    #[test]
    fn a_damped_half_sine_is_found_between_frames() {
        let (omega, gamma, v) = (100.0, 20.0, 2.0);
        let end = std::f64::consts::PI / omega;
        let e = libm::exp(-gamma * end);
        let sine = |t: f64| v / omega * libm::exp(-gamma * t) * libm::sin(omega * t);
        let overlap = |t: f64| match t {
            t if t < 0.0 => v * t,
            t if t > end => -e * v * (t - end),
            t => sine(t),
        };
        let speed = |t: f64| match t {
            t if t < 0.0 => v,
            t if t > end => -e * v,
            t => v * libm::exp(-gamma * t) * libm::cos(omega * t) - gamma * sine(t),
        };
        let (run, mut impacts, mut rows) = (Run::default(), Impacts::new((-1.0, 1.0)), Vec::new());
        for k in 0..60 {
            let t = -0.0057 + 0.001 * f64::from(k);
            let frame = Frame {
                time: t,
                id: vec![3],
                position: vec![Vec3::new(0.0, 0.0, 0.1 - overlap(t))],
                velocity: vec![Vec3::new(0.0, 0.0, -speed(t))],
                ..Frame::default()
            };
            impacts.observe(&run, RunMessage::Frame(frame), &mut rows).unwrap();
            let contact = Contact {
                grain: 3,
                partner: Partner::Wall(0),
                point: Vec3::zeros(),
                normal: Vec3::z(),
                force: Vec3::zeros(),
                work: 0.0,
                overlap: overlap(t),
            };
            let list = if overlap(t) > 0.0 { vec![contact] } else { Vec::new() };
            impacts.observe(&run, RunMessage::Contacts(Contacts { time: t, rows: list }), &mut rows).unwrap();
        }
        let summary = impacts.end(&run, &mut rows).unwrap();
        let get = |name: &str| summary.get(name).unwrap();
        assert_eq!(rows.len(), 1);
        let deepest = sine(libm::atan(omega / gamma) / omega);
        println!("{} {}", get("contact_time") / end - 1.0, get("overlap") / deepest - 1.0);
        assert!((get("contact_time") / end - 1.0).abs() < 2e-4);
        assert!((get("overlap") / deepest - 1.0).abs() < 1e-5);
        assert!((get("restitution") - e).abs() < 1e-12);
    }
}

//! Force of the grains on walls, over time, and the work of sliding on them: of whole walls, or of the contacts in a shape.
//!
//! ```text
//! F_wall = − Σ F_i        N = Σ |F_i·n|        W = Σ w
//! ```
//!
//! with the force F_i on grain i of each contact with a wall, its normal n, and the sliding work w since the frame before, also that of contacts which
//! have ended since. A run adds these up for whole walls over every step (`/wall_forces`): these are taken, as means over time. In a part of a wall, and
//! of runs without these sums, forces are those of contacts at the instants of frames; of whole walls without sums and contacts, those of instants.

use super::filter::WallContactFilter;
use crate::definition::{ArgumentKind, AskError, Asked, Figure, Frames, Measure, number};
use crate::observer::Observer;
use crate::run::SLACK;
use crate::sheet::{Chart, Head, Row, Summary};
use crate::statistics::Mean;
use crate::{Contacts, MeasureError, Partner, Run, RunMessage, WallForces};
use geom::Vec3;

/// Where the forces come from: what the run holds first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Source {
    /// Each contact, `/contacts`.
    Contacts,
    /// Whole walls at the instants of frames, `/wall_forces`.
    Walls,
    /// Whole walls over every step, `/wall_forces`.
    Means,
}

/// A run without either.
const NO_FORCES: MeasureError = MeasureError::Channel {
    topic: record::topic::WALL_FORCES,
    what: "forces on walls",
    cure: "set [output] wall_forces = true, or contacts = true for the force in a part of a wall",
};

/// Columns of what only sums over every step tell.
const OVER_STEPS: usize = 7;

/// Measures the force on walls.
pub struct WallForce {
    what: WallContactFilter,
    /// Whether forces are those of the instants of frames in any case.
    instants: bool,
    magnitudes: Vec<f64>,
    /// Of frames; with means over time, of these times their lengths.
    sum: Vec3,
    /// Time that means are of [s].
    length: f64,
    largest: f64,
    /// Time from which on frames are looked at [s], and when the first mean begins, where that is earlier [s].
    from: f64,
    early: Option<f64>,
    /// Whether each row so far came with its work.
    slides: bool,
    work: f64,
    touched: bool,
    source: Option<Source>,
    bounds: (Vec3, Vec3),
    /// A row that waits for the place of its wall.
    waiting: Option<Row>,
}

impl WallForce {
    pub fn new(what: WallContactFilter, instants: bool) -> WallForce {
        let none = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
        WallForce {
            what,
            instants,
            magnitudes: Vec::new(),
            sum: Vec3::zeros(),
            length: 0.0,
            from: f64::NEG_INFINITY,
            early: None,
            largest: 0.0,
            slides: true,
            work: 0.0,
            touched: false,
            source: None,
            bounds: none,
            waiting: None,
        }
    }

    fn of_contacts(&mut self, run: &Run, contacts: &Contacts) -> Result<Row, MeasureError> {
        for c in contacts.rows.iter().filter(|c| matches!(c.partner, Partner::Wall(_))) {
            self.bounds = (self.bounds.0.inf(&c.point), self.bounds.1.sup(&c.point));
        }
        let (mut count, mut force, mut normal, mut work) = (0u64, Vec3::zeros(), 0.0, 0.0);
        for c in self.what.of(run, contacts)? {
            self.touched = true;
            count += u64::from(c.acts());
            force -= c.force;
            normal += c.force.dot(&c.normal).abs();
            work += c.work;
        }
        self.work += work;
        self.add(force);
        let (count, size) = (count as f64, force.norm());
        let sums = [contacts.time, count, force.x, force.y, force.z, size, normal, work, self.work];
        Ok([&sums[..], &[f64::NAN; 3], &[f64::NAN; OVER_STEPS]].concat())
    }

    fn of_walls(&mut self, forces: &WallForces) -> Result<Row, MeasureError> {
        if self.what.shape.is_some() {
            return Err(MeasureError::WholeWalls);
        }
        let (mut count, mut force) = (0, Vec3::zeros());
        for wall in self.what.of_whole(forces)? {
            count += wall.contacts;
            force += wall.force;
        }
        self.touched |= count > 0;
        self.add(force);
        let unknown = f64::NAN;
        let (count, size) = (count as f64, force.norm());
        let sums = [forces.time, count, force.x, force.y, force.z, size, unknown, unknown, unknown];
        Ok([&sums[..], &self.shift(forces)?[..], &[unknown; OVER_STEPS]].concat())
    }

    /// Means over the steps of an interval; of the first frame, which has none, the forces of its instant.
    fn of_means(&mut self, forces: &WallForces, length: f64) -> Result<Row, MeasureError> {
        let (mut count, mut force, mut sums, mut walls) = (0, Vec3::zeros(), [0.0; 5], 0u32);
        let (mut largest, mut torque) = (f64::NAN, [f64::NAN; 3]);
        for wall in self.what.of_whole(forces)? {
            count += wall.contacts;
            walls += 1;
            let Some(means) = wall.means else {
                force += wall.force;
                continue;
            };
            self.touched |= means.largest > 0.0;
            force += means.force;
            largest = means.largest.max(largest);
            torque = means.torque.into();
            let of = [means.normal, means.sliding_work, means.power, means.impacts, means.impact_energy];
            sums.iter_mut().zip(of).for_each(|(sum, more)| *sum += more);
        }
        let [normal, work, power, impacts, energy] = sums;
        let known = length > 0.0;
        if known {
            let begin = forces.time - length;
            if self.magnitudes.is_empty() && begin < self.from - SLACK {
                self.early = Some(begin);
            }
            self.sum += force * length;
            self.length += length;
            self.largest = self.largest.max(largest);
            self.magnitudes.push(force.norm());
            self.work += work;
            self.slides &= !work.is_nan();
        }
        let over = |x: f64| if known { x } else { f64::NAN };
        // Reference points of several walls are apart.
        let torque = torque.map(|x| if walls == 1 { x } else { f64::NAN });
        let head = [forces.time, count as f64, force.x, force.y, force.z, force.norm()];
        let worked = if known { self.work } else { 0.0 };
        let work = [over(normal), over(work), worked];
        let rest = [largest, torque[0], torque[1], torque[2], over(power), over(impacts), over(energy)];
        Ok([&head[..], &work, &self.shift(forces)?[..], &rest].concat())
    }

    /// Whether means over every step are taken from a message: of whole walls, from the first frame on.
    fn takes_means(&mut self, forces: &WallForces, rows: &[Row]) -> bool {
        let begins = self.source.is_none_or(|source| source == Source::Contacts && rows.is_empty());
        if forces.interval.is_some() && self.what.shape.is_none() && !self.instants && begins {
            // Of one frame, contacts come first.
            let what = self.what.clone();
            let from = self.from;
            *self = WallForce { source: Some(Source::Means), from, ..WallForce::new(what, false) };
        }
        self.source == Some(Source::Means)
    }

    /// How far the wall has moved [m]; unknown where several are asked for.
    fn shift(&self, forces: &WallForces) -> Result<[f64; 3], MeasureError> {
        let mut walls = self.what.of_whole(forces)?;
        let one = walls.next().filter(|_| walls.next().is_none());
        Ok(one.and_then(|wall| wall.shift).map_or([f64::NAN; 3], Into::into))
    }

    fn add(&mut self, force: Vec3) {
        self.sum += force;
        self.magnitudes.push(force.norm());
        self.largest = self.largest.max(force.norm());
    }
}

impl Observer for WallForce {
    fn heads(&self) -> Vec<Head> {
        Head::list(&[
            ("time", "s"),
            ("contacts", "1"),
            ("fx", "N"),
            ("fy", "N"),
            ("fz", "N"),
            ("force", "N"),
            ("normal_sum", "N"),
            ("sliding_work", "J"),
            ("sliding_work_sum", "J"),
            ("shift_x", "m"),
            ("shift_y", "m"),
            ("shift_z", "m"),
            ("largest", "N"),
            ("tx", "N·m"),
            ("ty", "N·m"),
            ("tz", "N·m"),
            ("power", "W"),
            ("impacts", "1"),
            ("impact_energy", "J"),
        ])
    }

    fn observe(&mut self, run: &Run, message: RunMessage, rows: &mut Vec<Row>) -> Result<(), MeasureError> {
        match message {
            // Of one frame, contacts come first.
            RunMessage::Contacts(contacts) if matches!(self.source, None | Some(Source::Contacts)) => {
                self.source = Some(Source::Contacts);
                rows.extend(self.waiting.take());
                self.waiting = Some(self.of_contacts(run, &contacts)?);
            }
            RunMessage::WallForces(forces) if self.takes_means(&forces, rows) => {
                let length = forces.interval.unwrap_or(0.0);
                rows.push(self.of_means(&forces, length)?);
            }
            RunMessage::WallForces(forces) if self.source == Some(Source::Contacts) => {
                // The time of contacts is in nanoseconds.
                let same = |row: &Row| row.first().is_some_and(|time| (time - forces.time).abs() <= SLACK);
                if let Some(mut row) = self.waiting.take_if(|row| same(row)) {
                    let shift = row.len() - OVER_STEPS - 3;
                    row[shift..shift + 3].copy_from_slice(&self.shift(&forces)?);
                    rows.push(row);
                }
            }
            RunMessage::WallForces(forces) if self.source != Some(Source::Contacts) => {
                self.source = Some(Source::Walls);
                rows.push(self.of_walls(&forces)?);
            }
            _ => {}
        }
        Ok(())
    }

    fn end(&mut self, _: &Run, rows: &mut Vec<Row>) -> Result<Summary, MeasureError> {
        rows.extend(self.waiting.take());
        let source = self.source.ok_or(NO_FORCES)?;
        if !self.touched && self.bounds.0.x.is_finite() {
            let (low, high) = self.bounds;
            return Err(MeasureError::NothingInside {
                what: "contact with a wall",
                low: low.into(),
                high: high.into(),
            });
        }
        let means = source == Source::Means;
        let mean = self.sum / if means { self.length } else { self.magnitudes.len() as f64 };
        let sizes = Mean::of(&self.magnitudes);
        let size = if means { mean.norm() } else { sizes.mean };
        let summary = Summary::default()
            .with("mean_fx", "N", mean.x)
            .with("mean_fy", "N", mean.y)
            .with("mean_fz", "N", mean.z)
            .with("mean_force", "N", size)
            .with("deviation", "N", sizes.deviation)
            .with("largest_force", "N", self.largest);
        let summary = match source {
            Source::Contacts => summary
                .with("sliding_work", "J", self.work)
                .note("from recorded contacts: forces are those at the instants of frames"),
            Source::Means if self.slides => {
                summary.with("sliding_work", "J", self.work).note("sums over every step (/wall_forces)")
            }
            Source::Means => summary.note(
                "sums over every step (/wall_forces), without sliding work: [output] energy = true adds it",
            ),
            Source::Walls => summary.note(
                "from forces on whole walls (/wall_forces) at the instants of frames: they tell no normal forces and no sliding work; \
                 [output] contacts = true records these",
            ),
        };
        let early = self.early.map(|begin| {
            let [begin, from] = [begin, self.from].map(geom::Shown);
            format!("the first row with means is of the time since {begin} s, before --from {from} s")
        });
        let summary = early.into_iter().fold(summary, Summary::note);
        Ok(if self.touched { summary } else { summary.note("no grain touches a wall in these frames") })
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        let axes = [("fx", 2), ("fy", 3), ("fz", 4)];
        let chart = Chart::new("Force on walls").columns(("time [s]", 0), "force [N]", &axes, rows);
        if self.source == Some(Source::Walls) || !self.slides {
            return chart;
        }
        chart.columns(("time [s]", 0), "sliding work [J]", &[("", 8)], rows)
    }
}

impl Measure for WallForce {
    const NAME: &'static str = "wall-force";
    const HELP: &'static str = "Force on walls, and sliding work, over time: of the contacts in SHAPE; all: of whole walls, over every step";
    const ARGUMENT: ArgumentKind = ArgumentKind::Shape;
    const FRAMES: Frames = Frames::OverTime;
    const OPTIONS: &'static [&'static str] = &["wall", "instants"];
    const FIGURES: &'static [Figure] =
        &[number("wall-force", "mean_force"), number("peak-wall-force", "largest_force")];

    fn observer(asked: &Asked) -> Result<Box<dyn Observer>, AskError> {
        let measure = WallForce::new(WallContactFilter::asked_for(asked)?, asked.instants);
        Ok(Box::new(WallForce { from: asked.between.0, ..measure }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Contact;
    use serde_json::json;

    fn contact(z: f64, force: f64) -> Contact {
        let (point, normal) = (Vec3::new(0.0, 0.0, z), Vec3::z());
        let partner = Partner::Wall(0);
        Contact { grain: 0, partner, point, normal, force: Vec3::z() * force, work: 0.0, overlap: 0.0 }
    }

    /// A run of a servo holds contacts and forces on whole walls: a SHAPE takes the contacts, shifts come from the walls, whose time is not
    /// in nanoseconds, and normal forces that pull count with their size.
    #[test]
    fn a_servo_run_gives_contacts_in_a_shape_and_shifts_of_the_wall() {
        let shape = Some("box:-1,-1,-0.5,1,1,0.5".parse().unwrap());
        let filter = WallContactFilter { shape, wall: Some("lid".to_owned()) };
        let (mut measure, mut rows) = (WallForce::new(filter, false), Vec::new());
        let run = Run { walls: vec!["lid".to_owned()], ..Run::default() };
        for (time, exact) in [(0.0, 0.0), (0.009998728, 0.0099987276543)] {
            let contacts =
                Contacts { time, rows: vec![contact(0.0, 2.0), contact(0.0, -0.5), contact(0.9, 7.0)] };
            measure.observe(&run, RunMessage::Contacts(contacts), &mut rows).unwrap();
            let wall = json!({"name": "lid", "force": [0, 0, -8.5], "contacts": 3, "shift": [0, 0, exact]});
            let message = json!({"time": exact, "walls": [wall]}).to_string();
            let forces = WallForces::new(time, message.as_bytes()).unwrap();
            measure.observe(&run, RunMessage::WallForces(forces), &mut rows).unwrap();
        }
        measure.end(&run, &mut rows).unwrap();
        let short: Vec<[f64; 4]> = rows.iter().map(|r| [r[1], r[4], r[6], r[11]]).collect();
        assert_eq!(short, [[2.0, -1.5, 2.5, 0.0], [2.0, -1.5, 2.5, 0.0099987276543]]);
    }
}

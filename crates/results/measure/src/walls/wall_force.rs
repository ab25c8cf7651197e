//! Force of the grains on walls, over time, and the work of sliding on them: sums over the contacts in a shape.
//!
//! ```text
//! F_wall = − Σ F_i        N = Σ |F_i·n|        W = Σ w
//! ```
//!
//! with the force F_i on grain i of each contact with a wall, as the run records it, its normal n, and the sliding work w since
//! the frame before, also that of contacts which have ended since. A run without contacts may hold the same sums for
//! whole walls (`/wall_forces`): these are taken then, without normal forces and sliding work.

use crate::definition::{ArgumentKind, AskError, Asked, Figure, Frames, Measure, number};
use crate::observer::Observer;
use crate::run::SLACK;
use crate::sheet::{Chart, Head, Row, Summary};
use crate::statistics::Mean;
use crate::{Contact, Contacts, ForceOnWall, MeasureError, Partner, Run, RunMessage, WallForces};
use geom::{Shape, Vec3};

/// Which contacts are looked at.
#[derive(Debug, Clone)]
pub struct WallContactFilter {
    /// Contact points in this shape; `None`: everywhere.
    pub shape: Option<Shape>,
    /// Only this wall, by name or by index; `None`: all.
    pub wall: Option<String>,
}

impl WallContactFilter {
    /// The rows that are wanted, with those of contacts that have ended.
    ///
    /// # Errors
    /// A wall that the run does not name.
    pub fn of<'c>(
        &'c self,
        run: &'c Run,
        contacts: &'c Contacts,
    ) -> Result<impl Iterator<Item = &'c Contact> + 'c, MeasureError> {
        let wall = self.wall.as_ref().map(|name| index(&run.walls, name)).transpose()?;
        let wanted = move |c: &&Contact| match c.partner {
            Partner::Wall(j) => wall.is_none_or(|wall| wall == j) && self.holds_point(run, &c.point),
            Partner::Grain(_) => false,
        };
        Ok(contacts.rows.iter().filter(wanted))
    }

    /// The forces on the walls that are wanted.
    ///
    /// # Errors
    /// A wall that the run does not name.
    fn of_whole<'c>(
        &self,
        forces: &'c WallForces,
    ) -> Result<impl Iterator<Item = &'c ForceOnWall>, MeasureError> {
        let names: Vec<String> = forces.walls.iter().map(|w| w.name.clone()).collect();
        let wall = self.wall.as_ref().map(|name| index(&names, name)).transpose()?;
        let wanted = move |k: usize| wall.is_none_or(|wall| wall == k as u64);
        Ok(forces.walls.iter().enumerate().filter(move |(k, _)| wanted(*k)).map(|(_, w)| w))
    }

    fn holds_point(&self, run: &Run, point: &Vec3) -> bool {
        self.shape.as_ref().is_none_or(|shape| run.holds(shape, point))
    }
}

fn index(walls: &[String], name: &str) -> Result<u64, MeasureError> {
    let by_name = walls.iter().position(|w| w == name).map(|k| k as u64);
    let by_number = || name.parse().ok().filter(|k: &u64| walls.is_empty() || (*k as usize) < walls.len());
    let missing = || MeasureError::Name { name: name.to_owned(), has: walls.to_vec() };
    by_name.or_else(by_number).ok_or_else(missing)
}

/// Where the forces come from: what the run holds first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Source {
    /// Each contact, `/contacts`.
    Contacts,
    /// Whole walls, `/wall_forces`.
    Walls,
}

/// A run without either.
const NO_FORCES: MeasureError = MeasureError::Channel {
    topic: record::topic::CONTACTS,
    what: "contacts",
    cure: "set [output] contacts = true, or wall_forces = true for the force on whole walls",
};

/// Measures the force on walls.
pub struct WallForce {
    what: WallContactFilter,
    magnitudes: Vec<f64>,
    sum: Vec3,
    work: f64,
    touched: bool,
    source: Option<Source>,
    bounds: (Vec3, Vec3),
    /// A row that waits for the place of its wall.
    waiting: Option<Row>,
}

impl WallForce {
    pub fn new(what: WallContactFilter) -> WallForce {
        let none = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
        WallForce {
            what,
            magnitudes: Vec::new(),
            sum: Vec3::zeros(),
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
        let unknown = f64::NAN;
        let sums = [contacts.time, count, force.x, force.y, force.z, size, normal, work, self.work];
        Ok([&sums[..], &[unknown; 3]].concat())
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
        Ok([&sums[..], &self.shift(forces)?[..]].concat())
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
        ])
    }

    fn observe(&mut self, run: &Run, message: RunMessage, rows: &mut Vec<Row>) -> Result<(), MeasureError> {
        match message {
            // Of one frame, contacts come first.
            RunMessage::Contacts(contacts) if self.source != Some(Source::Walls) => {
                self.source = Some(Source::Contacts);
                rows.extend(self.waiting.take());
                self.waiting = Some(self.of_contacts(run, &contacts)?);
            }
            RunMessage::WallForces(forces) if self.source == Some(Source::Contacts) => {
                // The time of contacts is in nanoseconds.
                let same = |row: &Row| row.first().is_some_and(|time| (time - forces.time).abs() <= SLACK);
                if let Some(mut row) = self.waiting.take_if(|row| same(row)) {
                    let sums = row.len() - 3;
                    row[sums..].copy_from_slice(&self.shift(&forces)?);
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
        let mean = self.sum / self.magnitudes.len() as f64;
        let sizes = Mean::of(&self.magnitudes);
        let summary = Summary::default()
            .with("mean_fx", "N", mean.x)
            .with("mean_fy", "N", mean.y)
            .with("mean_fz", "N", mean.z)
            .with("mean_force", "N", sizes.mean)
            .with("deviation", "N", sizes.deviation)
            .with("largest_force", "N", self.magnitudes.iter().copied().fold(0.0, f64::max));
        let summary = match source {
            Source::Contacts => summary.with("sliding_work", "J", self.work).note("from recorded contacts"),
            Source::Walls => summary.note(
                "from forces on whole walls (/wall_forces): they tell no normal forces and no sliding work; \
                 [output] contacts = true records these",
            ),
        };
        Ok(if self.touched { summary } else { summary.note("no grain touches a wall in these frames") })
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        let axes = [("fx", 2), ("fy", 3), ("fz", 4)];
        let chart = Chart::new("Force on walls").columns(("time [s]", 0), "force [N]", &axes, rows);
        if self.source == Some(Source::Walls) {
            return chart;
        }
        chart.columns(("time [s]", 0), "sliding work [J]", &[("", 8)], rows)
    }
}

impl Measure for WallForce {
    const NAME: &'static str = "wall-force";
    const HELP: &'static str = "Force on walls, and sliding work, of the contacts in SHAPE over time; all: also of runs that hold forces on whole walls";
    const ARGUMENT: ArgumentKind = ArgumentKind::Shape;
    const FRAMES: Frames = Frames::OverTime;
    const OPTIONS: &'static [&'static str] = &["wall"];
    const FIGURES: &'static [Figure] =
        &[number("wall-force", "mean_force"), number("peak-wall-force", "largest_force")];

    fn observer(asked: &Asked) -> Result<Box<dyn Observer>, AskError> {
        Ok(Box::new(WallForce::new(WallContactFilter::asked_for(asked)?)))
    }
}

impl WallContactFilter {
    /// The contacts that were asked for: those in a shape, or all, on one wall, or on all.
    pub(crate) fn asked_for(asked: &Asked) -> Result<WallContactFilter, AskError> {
        let given = asked.shape()?;
        let shape = (given.text != "all").then(|| given.shape.clone());
        Ok(WallContactFilter { shape, wall: asked.wall.clone() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
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
        let (mut measure, mut rows) = (WallForce::new(filter), Vec::new());
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

//! Force of the grains on walls, over time, and the work of sliding on them: sums over the contacts in a shape.
//!
//! ```text
//! F_wall = − Σ F_i        W = Σ w
//! ```
//!
//! with the force F_i on grain i of each contact with a wall, as the run records it, and the sliding work w since
//! the frame before, also that of contacts which have ended since.

use crate::observer::{NO_CONTACTS, Observer};
use crate::sheet::{Chart, Head, Row, Summary};
use crate::statistics::Mean;
use crate::{Contact, Contacts, MeasureError, Partner, Run, RunMessage};
use geom::{Shape, Vec3};

/// Which contacts are looked at.
#[derive(Debug, Clone)]
pub struct WallContactFilter {
    /// Contact points in this shape.
    pub shape: Shape,
    /// Only this wall, by name or by index; `None`: all.
    pub wall: Option<String>,
    /// Only frames between these times [s].
    pub between: (f64, f64),
}

impl WallContactFilter {
    /// The rows that are wanted, with those of contacts that have ended.
    ///
    /// # Errors
    /// A wall that the run does not name.
    pub fn of<'c>(
        &'c self,
        run: &Run,
        contacts: &'c Contacts,
    ) -> Result<impl Iterator<Item = &'c Contact> + 'c, MeasureError> {
        let wall = self.wall.as_ref().map(|name| index(run, name)).transpose()?;
        let wanted = move |c: &&Contact| match c.partner {
            Partner::Wall(j) => wall.is_none_or(|wall| wall == j) && self.shape.contains(&c.point),
            Partner::Grain(_) => false,
        };
        Ok(contacts.rows.iter().filter(wanted))
    }

    /// Whether a time [s] is looked at.
    pub fn holds(&self, time: f64) -> bool {
        self.between.0 <= time && time <= self.between.1
    }
}

fn index(run: &Run, name: &str) -> Result<u64, MeasureError> {
    let by_name = run.walls.iter().position(|w| w == name).map(|k| k as u64);
    let by_number =
        || name.parse().ok().filter(|k: &u64| run.walls.is_empty() || (*k as usize) < run.walls.len());
    let missing = || MeasureError::Name { name: name.to_owned(), has: run.walls.clone() };
    by_name.or_else(by_number).ok_or_else(missing)
}

/// Measures the force on walls.
pub struct WallForce {
    what: WallContactFilter,
    magnitudes: Vec<f64>,
    sum: Vec3,
    work: f64,
    touched: bool,
    contact_frames: u64,
    bounds: (Vec3, Vec3),
}

impl WallForce {
    /// Of these contacts.
    pub fn new(what: WallContactFilter) -> WallForce {
        let none = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
        WallForce {
            what,
            magnitudes: Vec::new(),
            sum: Vec3::zeros(),
            work: 0.0,
            touched: false,
            contact_frames: 0,
            bounds: none,
        }
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
        ])
    }

    fn observe(&mut self, run: &Run, message: RunMessage, rows: &mut Vec<Row>) -> Result<(), MeasureError> {
        let RunMessage::Contacts(contacts) = message else { return Ok(()) };
        self.contact_frames += 1;
        if !self.what.holds(contacts.time) {
            return Ok(());
        }
        for c in contacts.rows.iter().filter(|c| matches!(c.partner, Partner::Wall(_))) {
            self.bounds = (self.bounds.0.inf(&c.point), self.bounds.1.sup(&c.point));
        }
        let (mut count, mut force, mut normal, mut work) = (0u64, Vec3::zeros(), 0.0, 0.0);
        for c in self.what.of(run, &contacts)? {
            self.touched = true;
            count += u64::from(c.acts());
            force -= c.force;
            normal += c.force.dot(&c.normal);
            work += c.work;
        }
        self.work += work;
        self.sum += force;
        self.magnitudes.push(force.norm());
        let (count, size) = (count as f64, force.norm());
        rows.push(vec![contacts.time, count, force.x, force.y, force.z, size, normal, work, self.work]);
        Ok(())
    }

    fn end(&mut self, _: &Run, _: &mut Vec<Row>) -> Result<Summary, MeasureError> {
        if self.contact_frames == 0 {
            return Err(NO_CONTACTS);
        }
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
            .with("largest_force", "N", self.magnitudes.iter().copied().fold(0.0, f64::max))
            .with("sliding_work", "J", self.work);
        Ok(if self.touched { summary } else { summary.note("no grain touches a wall in these frames") })
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        let axes = [("fx", 2), ("fy", 3), ("fz", 4)];
        Chart::new("Force on walls").columns(("time [s]", 0), "force [N]", &axes, rows).columns(
            ("time [s]", 0),
            "sliding work [J]",
            &[("", 8)],
            rows,
        )
    }
}

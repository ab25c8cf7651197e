//! Force of the grains on one side of a plane on those on the other side, over time.
//!
//! ```text
//! F = Σ F_b        over contacts of a grain a before the plane with a grain b behind it (n·(x_a − p) < 0 ≤ n·(x_b − p))
//! ```
//!
//! with the force F_b on b as the run records it: the traction that a cut through the plane has to replace. F·n is above
//! zero where grains before the plane press along its normal. In an upstream stage the grains of the zone are those
//! behind its storage plane: they feel no force, and their force on the others is counted. In a periodic box a contact through a face counts with
//! those images of its grains between which the plane is met in the box.

use crate::definition::{ArgumentKind, AskError, Asked, Frames, Measure};
use crate::observer::{NO_CONTACTS, Observer};
use crate::periodic::PeriodicBox;
use crate::sheet::{Chart, Head, Row, Summary};
use crate::statistics::Mean;
use crate::{Contact, Contacts, MeasureError, Partner, Run, RunMessage};
use geom::{Plane, Vec3};
use std::collections::HashMap;

/// Measures the force through a plane.
pub struct PlaneForce {
    plane: Plane,
    /// Place of each grain of the frame [m], by id.
    places: HashMap<u64, Vec3>,
    /// The box of the frame.
    periodic: PeriodicBox,
    /// Along the normal and across it, of every frame [N].
    sizes: [Vec<f64>; 2],
    counts: Vec<f64>,
    contact_frames: u64,
}

impl PlaneForce {
    /// Through a plane.
    pub fn new(plane: Plane) -> PlaneForce {
        let (places, sizes) = (HashMap::new(), [Vec::new(), Vec::new()]);
        let periodic = PeriodicBox::default();
        PlaneForce { plane, places, periodic, sizes, counts: Vec::new(), contact_frames: 0 }
    }

    /// The force of a contact on the grain behind the plane [N], once for each of its images through which the plane goes.
    fn on_behind(&self, contact: &Contact) -> Vec<Vec3> {
        let Partner::Grain(other) = contact.partner else { return Vec::new() };
        let [Some(i), Some(j)] = [contact.grain, other].map(|id| self.places.get(&id)) else {
            return Vec::new();
        };
        let from = *i;
        let to = from + self.periodic.way(i, j);
        let force = |shift: &Vec3| {
            let [at_i, at_j] = [from + shift, to + shift].map(|p| self.plane.signed_distance(&p));
            let meets = from + shift + (to - from) * (at_i / (at_i - at_j));
            match (at_i >= 0.0, at_j >= 0.0) {
                (true, false) if self.periodic.has(&meets) => Some(contact.force),
                (false, true) if self.periodic.has(&meets) => Some(-contact.force),
                _ => None,
            }
        };
        let ends = (from.inf(&to), from.sup(&to));
        self.periodic.shifts(ends, self.periodic.corners()).iter().filter_map(force).collect()
    }

    fn contacts(&mut self, contacts: &Contacts, rows: &mut Vec<Row>) {
        self.contact_frames += 1;
        let (count, force) = contacts
            .acting()
            .flat_map(|c| self.on_behind(c))
            .fold((0.0, Vec3::zeros()), |(count, sum), force| (count + 1.0, sum + force));
        let normal = force.dot(&self.plane.normal);
        let shear = (force - self.plane.normal * normal).norm();
        self.counts.push(count);
        self.sizes[0].push(normal);
        self.sizes[1].push(shear);
        rows.push(vec![contacts.time, count, force.x, force.y, force.z, normal, shear]);
    }
}

impl Observer for PlaneForce {
    fn heads(&self) -> Vec<Head> {
        Head::list(&[
            ("time", "s"),
            ("contacts", "1"),
            ("fx", "N"),
            ("fy", "N"),
            ("fz", "N"),
            ("normal", "N"),
            ("shear", "N"),
        ])
    }

    fn observe(&mut self, _: &Run, message: RunMessage, rows: &mut Vec<Row>) -> Result<(), MeasureError> {
        match message {
            RunMessage::Frame(frame) => {
                self.places.clear();
                self.places.extend(frame.id.iter().copied().zip(frame.position.iter().copied()));
                self.periodic = frame.periodic;
            }
            RunMessage::Contacts(contacts) => self.contacts(&contacts, rows),
            _ => {}
        }
        Ok(())
    }

    fn end(&mut self, _: &Run, _: &mut Vec<Row>) -> Result<Summary, MeasureError> {
        if self.contact_frames == 0 {
            return Err(NO_CONTACTS);
        }
        let [normal, shear] = [0, 1].map(|k| Mean::of(&self.sizes[k]));
        let summary = Summary::default()
            .with("mean_normal", "N", normal.mean)
            .with("normal_deviation", "N", normal.deviation)
            .with("mean_shear", "N", shear.mean)
            .with("mean_contacts", "1", Mean::of(&self.counts).mean);
        let never = self.counts.iter().all(|count| *count == 0.0);
        Ok(if never { summary.note("no contact crosses the plane in these frames") } else { summary })
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        let along = [("along the normal", 5), ("across", 6)];
        Chart::new("Force through the plane").columns(("time [s]", 0), "force [N]", &along, rows)
    }
}

impl Measure for PlaneForce {
    const NAME: &'static str = "plane-force";
    const HELP: &'static str =
        "Force through PLANE, of the contacts between grains on its two sides, over time";
    const ARGUMENT: ArgumentKind = ArgumentKind::Plane;
    const FRAMES: Frames = Frames::OverTime;

    fn observer(asked: &Asked) -> Result<Box<dyn Observer>, AskError> {
        Ok(Box::new(PlaneForce::new(asked.plane()?)))
    }
}

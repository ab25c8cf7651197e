//! Force of the grains on one side of a plane on those on the other side, over time.
//!
//! ```text
//! F = Σ F_b        over contacts of a grain a before the plane with a grain b behind it (n·(x_a − p) < 0 ≤ n·(x_b − p))
//! ```
//!
//! with the force F_b on b as the run records it: the traction that a cut through the plane has to replace. F·n is above
//! zero where grains before the plane press along its normal. In an upstream stage the grains of the zone are those
//! behind its storage plane: they feel no force, and their force on the others is counted.

use crate::observer::{NO_CONTACTS, Observer};
use crate::sheet::{Chart, Head, Row, Summary};
use crate::statistics::Mean;
use crate::{Contact, Contacts, MeasureError, Partner, Run, RunMessage};
use geom::{Plane, Vec3};
use std::collections::HashMap;

/// Measures the force through a plane.
pub struct PlaneForce {
    plane: Plane,
    /// Distance of each grain of the frame from the plane [m], by id.
    distances: HashMap<u64, f64>,
    /// Along the normal and across it, of every frame [N].
    sizes: [Vec<f64>; 2],
    counts: Vec<f64>,
    contact_frames: u64,
}

impl PlaneForce {
    /// Through a plane.
    pub fn new(plane: Plane) -> PlaneForce {
        let (distances, sizes) = (HashMap::new(), [Vec::new(), Vec::new()]);
        PlaneForce { plane, distances, sizes, counts: Vec::new(), contact_frames: 0 }
    }

    /// The force of a contact on the grain behind the plane [N], where its grains are on different sides.
    fn on_behind(&self, contact: &Contact) -> Option<Vec3> {
        let Partner::Grain(other) = contact.partner else { return None };
        let [i, j] = [contact.grain, other].map(|id| self.distances.get(&id).map(|d| *d >= 0.0));
        match (i?, j?) {
            (true, false) => Some(contact.force),
            (false, true) => Some(-contact.force),
            _ => None,
        }
    }

    fn contacts(&mut self, contacts: &Contacts, rows: &mut Vec<Row>) {
        self.contact_frames += 1;
        let (count, force) = contacts
            .acting()
            .filter_map(|c| self.on_behind(c))
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
                self.distances.clear();
                let distance = frame.position.iter().map(|p| self.plane.signed_distance(p));
                self.distances.extend(frame.id.iter().copied().zip(distance));
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

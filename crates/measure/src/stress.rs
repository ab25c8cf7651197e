//! Mean stress of grains in a shape, from the forces of their contacts and bonds.
//!
//! ```text
//! σ_ab = 1/V Σ s f_a l_b        positive in compression; made symmetric
//! p = tr σ / 3,   q = √(3/2 s_ab s_ab),  s = σ − p 1
//! ```
//!
//! Over contacts and bonds, with the force f on grain i [N], the branch l from the centre of the partner to that of i (from a wall: from the point of contact) [m] and
//! the share s of the branch that lies in the shape, to 1/64. For a shape around all grains it is the mean stress that follows from the forces on the walls (Weber
//! 1966, Bull. Liaison Ponts Chauss. 20; Bagi 1996, doi:10.1016/0167-6636(95)00044-5). What grains carry by moving (m v v) is not in it.

use crate::observer::{NO_CONTACTS, Observer, Which};
use crate::region::Region;
use crate::sheet::{Chart, Head, Row, Summary};
use crate::{Bonds, Contacts, Frame, MeasureError, Partner, Run, RunMessage};
use geom::Vec3;
use nalgebra::Matrix3;
use std::collections::HashMap;

/// Points of a branch that are looked at.
const POINTS: u32 = 64;

/// Measures the mean stress in a shape.
pub struct Stress {
    region: Region,
    which: Which,
    /// What has come of the present time.
    frame: Option<Frame>,
    contacts: Option<Contacts>,
    bonds: Option<Bonds>,
    last: Option<(f64, Matrix3<f64>)>,
    /// Times of the first and the last message of contacts [s].
    span: Option<(f64, f64)>,
}

impl Stress {
    /// In a region, at the times between two [s].
    ///
    /// # Errors
    /// A shape without end or without room.
    pub fn new(region: Region, (from, until): (f64, f64)) -> Result<Stress, MeasureError> {
        region.room()?;
        let which = Which::Between(from, until);
        Ok(Stress { region, which, frame: None, contacts: None, bonds: None, last: None, span: None })
    }

    /// What has come of another time than this one is complete.
    fn settle(&mut self, run: &Run, now: Option<f64>, rows: &mut Vec<Row>) {
        let time = self.frame.as_ref().map(|f| f.time);
        if time.is_none() || time == now {
            return;
        }
        let (frame, contacts, bonds) = (self.frame.take(), self.contacts.take(), self.bonds.take());
        let own = contacts.filter(|c| Some(c.time) == time);
        if let (Some(frame), Some(contacts)) = (frame, own) {
            let bonds = bonds.filter(|b| b.time == frame.time);
            let stress = self.stress(run, &frame, &contacts, bonds.as_ref());
            self.last = Some((frame.time, stress));
            rows.push(row(frame.time, &stress));
        }
    }

    fn stress(&self, run: &Run, frame: &Frame, contacts: &Contacts, bonds: Option<&Bonds>) -> Matrix3<f64> {
        let centres: HashMap<u64, Vec3> =
            frame.id.iter().copied().zip(frame.position.iter().copied()).collect();
        let centre = |id: &u64| centres.get(id).copied();
        let mut sum = Matrix3::zeros();
        let mut add = |from: Vec3, to: Vec3, force: Vec3| {
            let branch = run.way(&from, &to);
            sum += force * branch.transpose() * self.share(run, &from, &branch);
        };
        for contact in contacts.acting() {
            let from = match &contact.partner {
                Partner::Grain(other) => centre(other),
                Partner::Wall(_) => Some(contact.point),
            };
            from.zip(centre(&contact.grain)).into_iter().for_each(|(from, to)| add(from, to, contact.force));
        }
        for bond in bonds.iter().flat_map(|b| &b.rows).filter(|b| b.broken.is_none()) {
            let [to, from] = bond.grains.each_ref().map(centre);
            from.zip(to).into_iter().for_each(|(from, to)| add(from, to, bond.force));
        }
        (sum + sum.transpose()) * (0.5 / self.region.volume)
    }

    /// Share of a branch that lies in the region.
    fn share(&self, run: &Run, from: &Vec3, branch: &Vec3) -> f64 {
        let at = |k: u32| run.wrapped(&(from + branch * ((f64::from(k) + 0.5) / f64::from(POINTS))));
        let inside = (0..POINTS).filter(|k| self.region.shape.contains(&at(*k))).count();
        inside as f64 / f64::from(POINTS)
    }
}

/// p and q [Pa].
pub fn invariants(stress: &Matrix3<f64>) -> [f64; 2] {
    let pressure = stress.trace() / 3.0;
    let rest = stress - Matrix3::identity() * pressure;
    [pressure, (1.5 * rest.norm_squared()).sqrt()]
}

fn row(time: f64, stress: &Matrix3<f64>) -> Row {
    let parts = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(|at| stress[at]);
    [&[time], &parts[..], &invariants(stress)[..]].concat()
}

impl Observer for Stress {
    fn heads(&self) -> Vec<Head> {
        let parts = ["xx", "yy", "zz", "xy", "xz", "yz", "p", "q"].map(|name| (name, "Pa"));
        Head::list(&[&[("time", "s")], &parts[..]].concat())
    }

    fn observe(&mut self, run: &Run, message: RunMessage, rows: &mut Vec<Row>) -> Result<(), MeasureError> {
        let time = match &message {
            RunMessage::Frame(frame) => frame.time,
            RunMessage::Contacts(contacts) => contacts.time,
            RunMessage::Bonds(bonds) => bonds.time,
            _ => return Ok(()),
        };
        self.settle(run, Some(time), rows);
        let wanted = self.which.holds(run, time);
        match message {
            RunMessage::Contacts(contacts) => {
                self.span = Some((self.span.map_or(time, |span| span.0), time));
                self.contacts = Some(contacts).filter(|_| wanted);
            }
            RunMessage::Frame(frame) => self.frame = Some(frame).filter(|_| wanted),
            RunMessage::Bonds(bonds) => self.bonds = Some(bonds).filter(|_| wanted),
            _ => {}
        }
        Ok(())
    }

    fn end(&mut self, run: &Run, rows: &mut Vec<Row>) -> Result<Summary, MeasureError> {
        self.settle(run, None, rows);
        let span = self.span.ok_or(NO_CONTACTS)?;
        let (time, stress) = self.last.ok_or_else(|| self.which.missing(span))?;
        let [pressure, deviator] = invariants(&stress);
        Ok(Summary::default()
            .with("xx", "Pa", stress[(0, 0)])
            .with("yy", "Pa", stress[(1, 1)])
            .with("zz", "Pa", stress[(2, 2)])
            .with("p", "Pa", pressure)
            .with("q", "Pa", deviator)
            .with("time", "s", time))
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        let parts = [("xx", 1), ("yy", 2), ("zz", 3), ("q", 8)];
        Chart::new("Mean stress").columns(
            ("time [s]", 0),
            "stress, positive in compression [Pa]",
            &parts,
            rows,
        )
    }
}

//! Mean stress of grains in a shape, from the forces of their contacts and bonds.
//!
//! ```text
//! σ_ab = 1/V Σ s f_a l_b        positive in compression; made symmetric
//! p = tr σ / 3,   q = √(3/2 s_ab s_ab),  s = σ − p 1
//! ```
//!
//! Over contacts and bonds, with the force f on grain i [N], the branch l from the centre of the partner's grain to that of i (from a wall: from the point of contact) [m] and
//! the share s of the branch that lies in the shape ([`crate::geometry::chord`]). The centre of a member of a rigid clump is that of the clump. In a periodic box every image of a branch
//! counts ([`crate::periodic`]). For a shape around all grains it is the mean stress that follows from the forces on the walls (Weber
//! 1966, Bull. Liaison Ponts Chauss. 20; Bagi 1996, doi:10.1016/0167-6636(95)00044-5). What grains carry by moving (m v v) is not in it.

use crate::definition::{ArgumentKind, AskError, Asked, Frames, Measure};
use crate::observer::{NO_CONTACTS, Observer};
use crate::reading::time_slice::{Gathered, TimeSlice};
use crate::region::Region;
use crate::sheet::{Chart, Head, Row, Summary};
use crate::{Bonds, Contacts, Frame, MeasureError, Partner, Run, RunMessage};
use geom::Vec3;
use nalgebra::Matrix3;
use std::collections::HashMap;

/// A sphere: its centre [m], and from the centre of its grain to it [m].
#[derive(Clone, Copy)]
struct Member {
    centre: Vec3,
    arm: Vec3,
}

impl Member {
    /// A point on a wall.
    fn of_wall(point: Vec3) -> Member {
        Member { centre: point, arm: Vec3::zeros() }
    }

    fn of_frame(frame: &Frame) -> HashMap<u64, Member> {
        let rows = frame.id.iter().zip(&frame.position).zip(frame.grain_centres());
        let member = |((id, centre), grain): ((&u64, &Vec3), Vec3)| {
            (*id, Member { centre: *centre, arm: frame.periodic.way(&grain, centre) })
        };
        rows.map(member).collect()
    }
}

/// Measures the mean stress in a shape.
pub struct Stress {
    region: Region,
    gathered: Gathered,
    last: Option<(f64, Matrix3<f64>)>,
}

impl Stress {
    /// In a region.
    ///
    /// # Errors
    /// A shape without end or without room.
    pub fn new(region: Region) -> Result<Stress, MeasureError> {
        region.may_have_room()?;
        Ok(Stress { region, gathered: Gathered::default(), last: None })
    }

    fn add(&mut self, slice: Option<TimeSlice>, rows: &mut Vec<Row>) -> Result<(), MeasureError> {
        if let Some(TimeSlice { frame, contacts: Some(contacts), bonds }) = slice {
            let stress = self.stress(&frame, &contacts, bonds.as_ref())?;
            self.last = Some((frame.time, stress));
            rows.push(row(frame.time, &stress));
        }
        Ok(())
    }

    fn stress(
        &self,
        frame: &Frame,
        contacts: &Contacts,
        bonds: Option<&Bonds>,
    ) -> Result<Matrix3<f64>, MeasureError> {
        let region = self.region.within(&frame.periodic)?;
        region.fits(&frame.periodic)?;
        let members = Member::of_frame(frame);
        let member = |id: &u64| members.get(id).copied();
        let mut sum = Matrix3::zeros();
        let mut add = |from: Member, to: Member, force: Vec3| {
            let start = from.centre - from.arm;
            let branch = from.arm + frame.periodic.way(&from.centre, &to.centre) - to.arm;
            sum += force * branch.transpose() * region.share(&frame.periodic, &start, &branch);
        };
        for contact in contacts.acting() {
            let from = match &contact.partner {
                Partner::Grain(other) => member(other),
                Partner::Wall(_) => Some(Member::of_wall(contact.point)),
            };
            from.zip(member(&contact.grain)).into_iter().for_each(|(from, to)| add(from, to, contact.force));
        }
        for bond in bonds.iter().flat_map(|b| &b.rows).filter(|b| b.broken.is_none()) {
            let [to, from] = bond.grains.each_ref().map(member);
            from.zip(to).into_iter().for_each(|(from, to)| add(from, to, bond.force));
        }
        Ok((sum + sum.transpose()) * (0.5 / region.volume))
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

    fn observe(&mut self, _: &Run, message: RunMessage, rows: &mut Vec<Row>) -> Result<(), MeasureError> {
        let slice = self.gathered.add(message);
        self.add(slice, rows)
    }

    fn end(&mut self, _: &Run, rows: &mut Vec<Row>) -> Result<Summary, MeasureError> {
        let last = self.gathered.end();
        self.add(last, rows)?;
        let (time, stress) = self.last.ok_or(NO_CONTACTS)?;
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

impl Measure for Stress {
    const NAME: &'static str = "stress";
    const HELP: &'static str = "Mean stress in SHAPE, of the contacts and bonds in it, over time";
    const ARGUMENT: ArgumentKind = ArgumentKind::Room;
    const FRAMES: Frames = Frames::OverTime;

    fn observer(asked: &Asked) -> Result<Box<dyn Observer>, AskError> {
        Ok(Box::new(Stress::new(Region::new(asked.shape()?.shape.clone(), asked.volume))?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Contact;
    use crate::periodic::PeriodicBox;
    use record::column::{BODY, ID, MASS, POSITION, VELOCITY};
    use stream::{Table, Values};

    fn table(columns: &[(&str, &[f64])]) -> Table {
        let mut table = Table::default();
        columns.iter().for_each(|(name, values)| table.push(name, Values::F64(values.to_vec())).unwrap());
        table
    }

    fn frame(position: Vec<Vec3>, table: Table) -> Frame {
        let n = position.len();
        Frame {
            id: (0..n as u64).collect(),
            velocity: vec![Vec3::zeros(); n],
            radius: vec![0.1; n],
            material: vec![0; n],
            mass: vec![1.0; n],
            position,
            table,
            ..Frame::default()
        }
    }

    fn contact(grain: u64, partner: Partner, point: Vec3, force: Vec3) -> Contact {
        Contact { grain, partner, point, normal: force.normalize(), force, work: 0.0, overlap: 0.0 }
    }

    fn stress(shape: &str, frame: Frame, rows: Vec<Contact>) -> Matrix3<f64> {
        let mut stress = Stress::new(Region::new(shape.parse().unwrap(), 0.0)).unwrap();
        let (run, mut out) = (Run::default(), Vec::new());
        stress.observe(&run, RunMessage::Frame(frame), &mut out).unwrap();
        let contacts = Contacts { time: 0.0, rows };
        stress.observe(&run, RunMessage::Contacts(contacts), &mut out).unwrap();
        stress.end(&run, &mut out).unwrap();
        stress.last.unwrap().1
    }

    /// A dumbbell upright between two plates that press with F: by the plates alone, σ_zz = F h/V.
    #[test]
    fn a_clump_between_plates_has_the_stress_of_the_plates() {
        let z = [BODY, ID, MASS].map(str::to_owned);
        let mut columns: Vec<(&str, &[f64])> = vec![(&z[1], &[7.0]), (&z[2], &[2.0])];
        columns.extend(POSITION.iter().zip([&[0.0][..], &[0.0], &[0.5]]).map(|(name, x)| (*name, x)));
        columns.extend(VELOCITY.iter().map(|name| (*name, &[0.0][..])));
        let dumbbell =
            frame(vec![Vec3::new(0.0, 0.0, 0.2), Vec3::new(0.0, 0.0, 0.8)], table(&[(&z[0], &[7.0; 2])]));
        let dumbbell = dumbbell.with_clumps(&table(&columns), &[1000.0]).unwrap();
        let press = |grain: u64, z: f64, force: f64| {
            contact(grain, Partner::Wall(grain), Vec3::new(0.0, 0.0, z), Vec3::new(0.0, 0.0, force))
        };
        let found = stress("box:-1,-1,0,1,1,1", dumbbell, vec![press(0, 0.05, 3.0), press(1, 0.95, -3.0)]);
        assert!((found[(2, 2)] - 3.0 * 0.9 / 4.0).abs() < 1e-12, "{found}");
    }

    /// Two grains that touch across a periodic face carry the same stress in the cell, in a shape around the face and in a cell that is moved.
    #[test]
    fn a_branch_through_a_face_counts_in_each_shape_that_its_images_reach() {
        let cell = PeriodicBox { range: [Some((0.0, 1.0)), Some((0.0, 1.0)), Some((0.0, 1.0))] };
        let places = vec![Vec3::new(0.05, 0.5, 0.5), Vec3::new(0.9, 0.5, 0.5)];
        let of = |shape: &str| {
            let grains = Frame { periodic: cell, ..frame(places.clone(), Table::default()) };
            stress(shape, grains, vec![contact(0, Partner::Grain(1), Vec3::new(0.98, 0.5, 0.5), Vec3::x())])
        };
        // Whole cell; moved by half a period; eight periods; the branch is 0.15 m long.
        for (shape, branch, volume) in [
            ("box:0,0,0,1,1,1", 0.15, 1.0),
            ("box:-0.5,-0.5,-0.5,0.5,0.5,0.5", 0.15, 1.0),
            ("box:0,0,0,2,2,2", 8.0 * 0.15, 8.0),
            // The SHAPE `all`.
            ("halfspace:0,0,-1e100,0,0,1", 0.15, 1.0),
            ("box:0.9,0.4,0.4,1,0.6,0.6", 0.1, 0.004),
            ("box:-0.1,0.4,0.4,0.01,0.6,0.6", 0.11, 0.11 * 0.04),
        ] {
            let found = of(shape)[(0, 0)];
            assert!((found / (branch / volume) - 1.0).abs() < 1e-9, "{shape}: {found}");
        }
    }
}

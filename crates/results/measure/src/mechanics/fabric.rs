//! How the contacts between grains are directed: the fabric tensor.
//!
//! ```text
//! F_ab = 1/C Σ n_a n_b        over the C contacts between grains, n: normal; tr F = 1
//! a_ab = 15/2 (F_ab − δ_ab/3)                   the normals are spread as 1 + a_ab n_a n_b;   anisotropy √(3/2 a_ab a_ab)
//! ```
//!
//! Satake (1982), IUTAM Symposium on Deformation and Failure of Granular Materials, 63–68; Kanatani (1984), doi:10.1016/0020-7225(84)90090-9. Contacts with walls have the directions of the walls, and do not count.

use crate::definition::{AskError, Asked, Frames, Measure};
use crate::observer::{NO_CONTACTS, Observer};
use crate::sheet::{Chart, Head, Row, Summary};
use crate::{Contacts, MeasureError, Partner, Run, RunMessage};
use nalgebra::Matrix3;

/// Measures the fabric of the contacts between grains.
#[derive(Default)]
pub struct Fabric {
    last: Option<Row>,
}

/// Number of contacts between grains, and their fabric; NaN without any.
fn fabric(contacts: &Contacts) -> (usize, Matrix3<f64>) {
    let between = contacts.acting().filter(|c| matches!(c.partner, Partner::Grain(_)));
    let (count, sum) = between.fold((0, Matrix3::zeros()), |(count, sum), contact| {
        (count + 1, sum + contact.normal * contact.normal.transpose())
    });
    (count, sum / count as f64)
}

/// The anisotropy [–].
fn anisotropy(fabric: &Matrix3<f64>) -> f64 {
    let rest = fabric - Matrix3::identity() / 3.0;
    7.5 * (1.5 * rest.norm_squared()).sqrt()
}

fn row(contacts: &Contacts) -> Row {
    let (count, fabric) = fabric(contacts);
    let parts = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(|at| fabric[at]);
    [&[contacts.time, count as f64], &parts[..], &[anisotropy(&fabric)]].concat()
}

impl Observer for Fabric {
    fn heads(&self) -> Vec<Head> {
        let names = ["contacts", "xx", "yy", "zz", "xy", "xz", "yz", "anisotropy"].map(|name| (name, "1"));
        Head::list(&[&[("time", "s")], &names[..]].concat())
    }

    fn observe(&mut self, _: &Run, message: RunMessage, rows: &mut Vec<Row>) -> Result<(), MeasureError> {
        if let RunMessage::Contacts(contacts) = message {
            rows.push(row(&contacts));
            self.last = rows.last().cloned();
        }
        Ok(())
    }

    fn end(&mut self, _: &Run, _: &mut Vec<Row>) -> Result<Summary, MeasureError> {
        let last = self.last.as_ref().ok_or(NO_CONTACTS)?;
        let names = ["contacts", "xx", "yy", "zz", "xy", "xz", "yz", "anisotropy"];
        let summary =
            names.iter().zip(&last[1..]).fold(Summary::default(), |s, (name, v)| s.with(name, "1", *v));
        Ok(summary.with("time", "s", last[0]))
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        let parts = [("xx", 2), ("yy", 3), ("zz", 4)];
        Chart::new("Fabric").columns(("time [s]", 0), "fabric [1]", &parts, rows)
    }
}

impl Measure for Fabric {
    const NAME: &'static str = "fabric";
    const HELP: &'static str = "Fabric tensor and anisotropy of the contacts between grains, over time";
    const FRAMES: Frames = Frames::OverTime;

    fn observer(_: &Asked) -> Result<Box<dyn Observer>, AskError> {
        Ok(Box::<Fabric>::default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Contact;
    use geom::Vec3;
    use geom::random::{generator, unit};

    fn contacts(rows: impl Iterator<Item = (Vec3, Partner)>) -> Contacts {
        let contact = |(normal, partner)| Contact {
            grain: 1,
            partner,
            point: Vec3::zeros(),
            normal,
            force: normal,
            work: 0.0,
            overlap: 0.0,
        };
        Contacts { time: 2.0, rows: rows.map(contact).collect() }
    }

    /// Normals with a density of 1 + a (3 cos² − 1)/2 about z: the trace is 1, and a is found again. Walls do not count.
    #[test]
    fn the_trace_is_one_and_a_known_anisotropy_is_found() {
        let mut random = generator(5, 1, 0);
        let wanted = 0.8;
        let mut normals = Vec::new();
        while normals.len() < 60_000 {
            let (z, turn) = (2.0 * unit(&mut random) - 1.0, std::f64::consts::TAU * unit(&mut random));
            let density = 1.0 + wanted * 0.5 * (3.0 * z * z - 1.0);
            if unit(&mut random) * 2.0 < density {
                let r = (1.0 - z * z).sqrt();
                normals.push((Vec3::new(r * turn.cos(), r * turn.sin(), z), Partner::Grain(2)));
            }
        }
        let even = row(&contacts(normals.iter().copied()));
        assert!((even[2] + even[3] + even[4] - 1.0).abs() < 1e-12, "{even:?}");
        assert!((even[8] - 1.5 * wanted).abs() < 0.04, "{even:?}");
        assert!((even[4] - (1.0 / 3.0 + 2.0 / 15.0 * wanted)).abs() < 0.004, "{even:?}");
        let walls = (0..999).map(|_| (Vec3::x(), Partner::Wall(0)));
        assert_eq!(row(&contacts(normals.into_iter().chain(walls))), even);
    }
}

//! Crushing of a single stone of bonded grains between two plates, in a random orientation for each seed.
//!
//! ```text
//! strength = F_max/d²     F_max: from the first crack on     d: distance of the plates when they touch the stone
//! ```
//! Jaeger (1967), doi:10.1016/0148-9062(67)90046-0. A stone on a corner may turn before it breaks: what it bore until then is no strength.
//! The sample is one cluster in `[[particles]]`; strengths of its bonds are drawn from the seed.

use super::plates::uneven;
use super::*;
use crate::composing::walls::PLATE;
use crate::series::peak;
use geom::random::{generator, random_orientation};

pub struct Crush;

/// Kind of the random numbers that orient a stone.
const ORIENTATION: u64 = 0x6c61;
/// Way of the plate over the distance of the plates at the end [–].
const END: f64 = 0.05;

/// The grains of the stone as they lie: in the orientation of the seed, on the plane z = 0.
fn lying(of: &Context) -> Vec<(Vec3, f64)> {
    let spheres = of.sample.grains.packed.as_ref().map_or(&[][..], |packed| &packed.spheres);
    let turn = random_orientation(&mut generator(of.loading.seed, ORIENTATION, 0));
    let turned: Vec<(Vec3, f64)> = spheres.iter().map(|(centre, radius)| (turn * centre, *radius)).collect();
    let low = turned.iter().map(|(c, r)| c.z - r).fold(f64::INFINITY, f64::min);
    turned.into_iter().map(|(c, r)| (c - Vec3::z() * low, r)).collect()
}

fn height(of: &Context) -> f64 {
    lying(of).iter().map(|(c, r)| c.z + r).fold(0.0, f64::max)
}

/// Row of the largest force from the last row before a crack on; `None` without cracks.
fn strongest(curve: &Curve) -> Option<usize> {
    let first = curve.column("cracks").iter().position(|cracks| *cracks > 0.0)?.saturating_sub(1);
    peak(curve.column("force").get(first..)?).map(|row| first + row)
}

impl Recipe for Crush {
    fn name(&self) -> &'static str {
        "crush"
    }

    fn stresses(&self) -> (Stresses, &'static [f64]) {
        (Stresses::None, &[])
    }

    fn proportions(&self) -> ([f64; 3], f64) {
        ([1.0, 1.0, 1.0], 1.0)
    }

    fn is_random(&self, _: &Sample) -> bool {
        // The orientation.
        true
    }

    fn check(&self, sample: &Sample, request: &Request) -> Result<()> {
        let why = "no stress acts on the stone (use --speed)";
        unused(request.inertial.is_some(), "--inertial", "crush", why)?;
        unused(request.friction.is_some(), "--friction", "crush", "the stone is not prepared")?;
        unused(request.rest.is_some(), "--rest", "crush", "the stone is not prepared")?;
        let wrong = |what, cure| sample.refusal(what, cure);
        if !sample.has("bond") {
            return Err(wrong("has no [[bond]]", "a stone that breaks needs one"));
        }
        match &sample.grains.packed {
            Some(packed) if packed.one_body => Ok(()),
            Some(_) => Err(wrong(
                "its [[particles]] are not one cluster",
                "give the grains of one stone, with cluster = 1",
            )),
            None => Err(wrong(
                "has a [[fill]]",
                "give the grains of one stone as [[particles]], with cluster = 1",
            )),
        }
    }

    fn preparation(&self, _: &Context) -> Result<Option<Part>> {
        Ok(None)
    }

    fn test(&self, of: &Context, _: &Prepared) -> Result<Part> {
        let (height, speed) = (height(of), of.request.speed_of_plate(&of.sample.grains));
        let until = of.request.strain.unwrap_or(END) * height / speed;
        let text = output(until, of.request.rows)
            + &wall("lower", &plane(Vec3::zeros(), [0, 0, 1]), PLATE, "")
            + &wall(
                "upper",
                &plane(Vec3::z() * height, [0, 0, -1]),
                PLATE,
                &translate(Vec3::z() * -speed, 0.0),
            );
        let row = |(c, r): &(Vec3, f64)| [c.x, c.y, c.z, *r].map(number).join(",") + "\n";
        let rows: String = lying(of).iter().map(row).collect();
        let files = vec![("stone.csv".into(), format!("x,y,z,radius\n{rows}"))];
        Ok(Part { until, text, files, bonds: true, grains: Some("stone.csv".into()), ..Part::default() })
    }

    fn tables(&self, of: &Context, _: &Prepared) -> Vec<(&'static str, Vec<String>)> {
        let walls = ["lower", "upper"].map(|name| (name, force_on(name)));
        walls.into_iter().chain(cracks(of.sample)).collect()
    }

    fn curve(&self, of: &Context, _: &Prepared, tables: &Tables) -> Result<Curve> {
        let height = height(of);
        let times = tables.column("upper", "time")?;
        let shift = tables.column("upper", "shift_z")?;
        let force = tables.column("upper", "fz")?;
        let curve = Curve::default()
            .with("time", "s", times.clone())
            .with("displacement", "m", shift.iter().map(|shift| -shift).collect())
            .with("force", "N", force.clone())
            .with("lower_force", "N", tables.column("lower", "fz")?.iter().map(|f| -f).collect())
            .with("stress", "Pa", force.iter().map(|f| f / (height * height)).collect());
        tables.finish(curve, &times)
    }

    fn peak(&self) -> Option<&'static str> {
        Some("force")
    }

    fn values(&self, of: &Context, curve: &Curve) -> Vec<Value> {
        let top = strongest(curve);
        let there = |column: &str| top.map_or(f64::NAN, |top| curve.column(column)[top]);
        let value = |name, unit, value| Value { name, unit, value };
        vec![
            value("strength", "Pa", there("stress")),
            value("force", "N", there("force")),
            value("height", "m", height(of)),
            value("displacement_at_strength", "m", there("displacement")),
            value("cracks_at_strength", "", there("cracks")),
        ]
    }

    fn warnings(&self, of: &Context, curve: &Curve) -> Vec<String> {
        let Some(top) = strongest(curve) else {
            let way = curve.column("displacement").last().copied().unwrap_or(0.0);
            return vec![format!(
                "no bond has broken when the plate has moved {way:.2e} m, so the stone has no strength: it turned between the plates, or --strain must be larger (now {})",
                of.request.strain.unwrap_or(END)
            )];
        };
        let speed = of.request.speed_of_plate(&of.sample.grains);
        uneven(curve, ["force", "lower_force"], "N", top, speed).into_iter().collect()
    }

    fn axes(&self) -> (&'static str, &'static [&'static str]) {
        ("displacement", &["force", "cracks"])
    }
}

//! Triaxial compression without walls: a periodic domain under σ₃ on all sides is compressed along z.
//!
//! Stress is the mean over all contacts and bonds, so no wall disturbs the packing. The equations are those of [`super::triaxial`].

use super::triaxial::{END, Triaxial, compressed, drawn};
use super::*;

pub struct TriaxialPeriodic;

/// Axes and what each follows, as text.
fn strains(axes: [String; 3]) -> String {
    let [x, y, z] = axes;
    format!("[domain.strain]\nx = {{ {x} }}\ny = {{ {y} }}\nz = {{ {z} }}\n\n")
}

/// A stress [Pa] that is followed no faster than a rate [1/s].
fn follow(stress: f64, limit: f64) -> String {
    format!("stress = {}, rate_limit = {}", number(stress), number(limit))
}

/// Largest rate of strain with which the stress is followed [1/s].
fn limit(of: &Context) -> f64 {
    of.request.speed_limit(&of.sample.grains, of.loading.stress, of.specimen.height) / of.specimen.height
}

/// Rate of the test [1/s].
fn rate(of: &Context) -> f64 {
    let by_speed = of.request.speed.map(|speed| speed / of.specimen.height);
    by_speed.unwrap_or_else(|| of.request.rate(&of.sample.grains, of.loading.stress))
}

impl Recipe for TriaxialPeriodic {
    fn name(&self) -> &'static str {
        "triaxial-periodic"
    }

    fn stresses(&self) -> (Stresses, &'static [f64]) {
        (Stresses::Each, &[2.5e4, 5e4, 1e5])
    }

    fn proportions(&self) -> ([f64; 3], f64) {
        ([1.0, 1.0, 1.0], 1.0)
    }

    fn is_pressed_all_round(&self) -> bool {
        true
    }

    fn check(&self, sample: &Sample, _: &Request) -> Result<()> {
        let refuse = |what, cure| Err(sample.refusal(what, cure));
        if sample.grains.gravity > 0.0 {
            return refuse(
                "has gravity, and nothing holds a specimen without walls",
                "take it out, or give --set 'gravity=[0,0,0]'",
            );
        }
        if sample.is_packed() {
            return refuse(
                "has packed grains, which do not fit together across periodic faces",
                "give one [[fill]] instead, or use the test triaxial",
            );
        }
        Ok(())
    }

    fn preparation(&self, of: &Context) -> Result<Option<Part>> {
        let (limit, stress) = (limit(of), of.loading.stress);
        let until = 20.0 / limit;
        let corner = |c: Vec3| format!("[{}, {}, {}]", number(c.x), number(c.y), number(c.z));
        let domain = format!(
            "[domain]\nperiodic = [\"x\", \"y\", \"z\"]\nlow = {}\nhigh = {}\n",
            corner(of.specimen.low),
            corner(of.specimen.high)
        );
        let press = || follow(stress, limit);
        let text = output(until, 20) + damping(of.sample) + &domain + &strains([press(), press(), press()]);
        Ok(Some(Part { until, to_rest: true, text, ..Part::default() }))
    }

    fn test(&self, of: &Context, _: &Prepared) -> Result<Part> {
        let rate = rate(of);
        let until = -(-of.request.strain.unwrap_or(END)).ln_1p() / rate;
        let side = || follow(of.loading.stress, limit(of).max(2.0 * rate));
        let domain = "[domain]\nperiodic = [\"x\", \"y\", \"z\"]\nsource = \"prepare.mcap\"\n";
        let driven = format!("rate = {}", number(rate));
        let text = output(until, of.request.rows) + domain + &strains([side(), side(), driven]);
        Ok(Part { until, text, bonds: true, ..Part::default() })
    }

    fn tables(&self, of: &Context, _: &Prepared) -> Vec<(&'static str, Vec<String>)> {
        let domain = ("domain", vec!["--domain".to_owned()]);
        std::iter::once(domain).chain(cracks(of.sample)).collect()
    }

    fn curve(&self, _: &Context, _: &Prepared, tables: &Tables) -> Result<Curve> {
        let column = |name: &str| tables.column("domain", name);
        // From logarithmic strains to shares of the length, and of the volume, at the start.
        let share = |values: Vec<f64>| values.into_iter().map(|e| -(-e).exp_m1()).collect::<Vec<f64>>();
        let times = column("time")?;
        let strains = [column("strain_x")?, column("strain_y")?, column("strain_z")?].map(share);
        let stresses = [column("xx")?, column("yy")?, column("zz")?];
        let curve = drawn(&times, strains, share(column("volumetric_strain")?), stresses);
        tables.finish(curve, &times)
    }

    fn room(&self, _: &Context, _: &Prepared, tables: &Tables) -> Result<Option<Room>> {
        let [x, y, z] = ["length_x", "length_y", "length_z"].map(|name| tables.column("domain", name));
        Ok(Some(Room::of_box([x?, y?, z?])))
    }

    fn measured(&self, _: &Context) -> Option<(String, Option<f64>)> {
        Some(("all".to_owned(), None))
    }

    fn sheared(&self, of: &Context, curve: &Curve) -> Option<Vec<f64>> {
        Triaxial.sheared(of, curve)
    }

    fn peak(&self) -> Option<&'static str> {
        Triaxial.peak()
    }

    fn values(&self, _: &Context, curve: &Curve) -> Vec<Value> {
        compressed(curve)
    }

    fn axes(&self) -> (&'static str, &'static [&'static str]) {
        Triaxial.axes()
    }

    fn envelope(&self) -> Option<Envelope> {
        Some(Envelope::Circles)
    }
}

//! A start from four questions: what, how large, how wet, and at which angle does it lie?
//!
//! ```text
//! θ = 68.61 μ^(0.27 + 0.22) (μ_r R)^(0.06 + 0.12) d^−0.2     θ in degrees, R and d in mm; grains and walls alike
//! ```
//!
//! Zhou, Xu, Yu & Zulli (2002), doi:10.1016/S0032-5910(01)00520-4, a fit to heaps of glass spheres of 2 to 10 mm: one angle gives a line of sliding
//! and rolling friction, not a point. A liquid bridge holds up to 2πRγ (Willett et al. 2000, doi:10.1021/la000657y).

use crate::error::{CalibrateError, Result};
use crate::recipe::shown;
use geom::Shown;
use scene::materials::{Material, Range, find};
use std::fmt::Write as _;

/// How wet the material is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Moisture {
    /// No liquid between grains.
    Dry,
    /// Liquid bridges between grains.
    Damp,
    /// Gaps are full of liquid.
    Wet,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Answers {
    /// Name of the material.
    pub material: String,
    /// Diameter of the grains [m].
    pub size: f64,
    /// How wet it is.
    pub moisture: Moisture,
    /// Angle of repose [°].
    pub repose: f64,
}

/// Sizes of the spheres that the angle was fitted to [m].
const FITTED: [f64; 2] = [0.002, 0.010];
/// Surface tension of water [N/m].
const WATER: f64 = 0.072;
/// Keys of a material and of a contact, and what stands where the table has none: value, and why.
const MATERIAL_KEYS: [(&str, f64); 3] = [("density", 2500.0), ("young", 1e7), ("poisson", 0.25)];
/// A modulus that a DEM can afford; harder grains seldom change the flow.
const AFFORDED: f64 = 1e7;

/// Most rolling resistance that is proposed: with more, grains hardly roll at all.
const MOST_ROLLING: f64 = 1.0;

/// Rolling resistance at which spheres of sliding friction `mu` lie at the angle.
fn rolling(answers: &Answers, mu: f64) -> f64 {
    let d = answers.size * 1e3;
    let length = answers.repose / 68.61 * libm::pow(d, 0.2) / libm::pow(mu, 0.49);
    libm::pow(length, 1.0 / 0.18) / (0.5 * d)
}

/// The start as a part of a scene, with intervals and sources as comments, and a part of a recipe.
///
/// # Errors
/// An unknown material, a size or an angle that cannot be.
pub fn start(answers: &Answers) -> Result<String> {
    let material = find(&answers.material).map_err(CalibrateError::Usage)?;
    let (d, angle) = (answers.size, answers.repose);
    if !(1e-6..=1.0).contains(&d) {
        return Err(CalibrateError::Usage(format!(
            "--size {d} m: give the diameter of a grain from 1e-6 to 1 m, such as \"5 mm\""
        )));
    }
    if !(5.0..=60.0).contains(&angle) {
        return Err(CalibrateError::Usage(format!(
            "--repose-deg {angle}: give an angle from 5 to 60 degrees"
        )));
    }
    let mut text = format!(
        "# A start for {}, {} mm, {angle}°. Ranges are of the sources; calibrate before you trust it.\n",
        material.name,
        Shown(d * 1e3)
    );
    let _ = writeln!(text, "[[material]]\nname = \"{}\"", material.name);
    for (key, other) in MATERIAL_KEYS {
        text += &line(&material, key, other);
    }
    text += "\n[[contact]]\nbetween = [\"*\", \"*\"]\nlaw = \"hertz\"\n";
    text += &line(&material, "restitution", 0.5);
    text += &frictions(&material, answers);
    text += &moisture(&material, answers);
    Ok(text + &recipe(&material))
}

/// `key = value  # range, source`.
fn line(material: &Material, key: &str, other: f64) -> String {
    let Some(Range { ends: [low, high], source, .. }) = material.ranges.get(key) else {
        return format!(
            "{key} = {}  # no source in the table: measure it, or see whether it matters\n",
            shown(other)
        );
    };
    if key == "young" && *low > AFFORDED {
        return format!(
            "{key} = {}  # softened; grains have {} to {} Pa: {source}\n",
            shown(AFFORDED),
            shown(*low),
            shown(*high)
        );
    }
    let middle: f64 = format!("{:.2e}", 0.5 * (low + high)).parse().unwrap_or(*low);
    format!("{key} = {}  # {} to {}: {source}\n", shown(middle), shown(*low), shown(*high))
}

fn frictions(material: &Material, answers: &Answers) -> String {
    let range = material.ranges.get("sliding_friction").map_or([0.2, 0.8], |r| r.ends);
    let middle = 0.5 * (range[0] + range[1]);
    let at = |mu: f64| {
        let asked = rolling(answers, mu);
        let beyond = if asked > MOST_ROLLING {
            format!(" (the formula gives {asked:.2}: this friction is too low for the angle)")
        } else {
            String::new()
        };
        (asked.min(MOST_ROLLING), beyond)
    };
    let mut text = line(material, "sliding_friction", middle);
    let (rolling, beyond) = at(middle);
    let _ = writeln!(
        text,
        "rolling_resistance = {rolling:.3}  # from the angle{beyond}; it cannot tell rolling from sliding friction:"
    );
    for mu in [range[0], middle, range[1]] {
        let (rolling, beyond) = at(mu);
        let _ = writeln!(text, "#   sliding_friction {mu:.2} with rolling_resistance {rolling:.3}{beyond}");
    }
    let inside = answers.size >= FITTED[0] && answers.size <= FITTED[1];
    let far = if inside { "" } else { "; this size is outside" };
    text + "# (Zhou, Xu, Yu & Zulli 2002, doi:10.1016/S0032-5910(01)00520-4: glass spheres of 2 to 10 mm"
        + far
        + "). A discharge or a shear test tells them apart.\n"
}

fn moisture(material: &Material, answers: &Answers) -> String {
    let density = material.ranges.get("density").map_or(2500.0, |r| 0.5 * (r.ends[0] + r.ends[1]));
    let weight = geom::sphere::volume(0.5 * answers.size) * density * 9.81;
    let bridge = std::f64::consts::PI * answers.size * WATER;
    match answers.moisture {
        Moisture::Dry => String::new(),
        Moisture::Damp => format!(
            "# Damp: a bridge of water holds up to {:.1e} N, {} times the weight of a grain (Willett et al. 2000, doi:10.1021/la000657y): add cohesion if this is above 1.\n",
            bridge,
            Shown(bridge / weight)
        ),
        Moisture::Wet => "# Wet: without bridges there is no cohesion; water carries a part of the weight: add [drag] with buoyancy.\n".to_owned(),
    }
}

fn recipe(material: &Material) -> String {
    let mut text = "\n# For a recipe of calibrate:\n".to_owned();
    for key in ["sliding_friction", "rolling_resistance"] {
        let prior = if material.ranges.contains_key(key) {
            format!("prior = \"material:{}\"", material.name)
        } else {
            "bounds = [0.05, 1.0]".to_owned()
        };
        let _ = writeln!(text, "# [[parameter]]\n# name = \"{key}\"\n# {prior}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_start_has_values_ranges_and_sources() {
        let answers =
            Answers { material: "Glass".to_owned(), size: 0.005, moisture: Moisture::Damp, repose: 25.0 };
        let text = start(&answers).unwrap();
        assert!(text.contains("restitution = 0.97") && text.contains("doi:10.1063/1.868282"), "{text}");
        assert!(text.contains("young = 1e7") || text.contains("young = 10000000"), "{text}");
        assert!(text.contains("times the weight"), "{text}");
        // A steeper heap rolls less easily, and one that slides less easily needs less rolling resistance.
        let steeper = Answers { repose: 30.0, ..answers.clone() };
        assert!(
            rolling(&steeper, 0.3) > rolling(&answers, 0.3)
                && rolling(&answers, 0.5) < rolling(&answers, 0.3)
        );
        let why = start(&Answers { material: "sandd".to_owned(), ..answers }).unwrap_err().to_string();
        assert!(why.contains("did you mean 'sand'?"), "{why}");
    }
}

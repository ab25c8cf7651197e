//! What is said about a hull.

use crate::args::Args;
use crate::views::Found;
use geom::Shown;
use geom::mesh::TriMesh;
use photos::Turntable;
use photos::adjusted::Adjustment;
use photos::hull::Agreement;
use photos::refine::Refinement;
use rayon::prelude::*;

/// A mask that the hull covers less is doubtful.
const MISSED: f64 = 0.03;
/// Photographs that are named.
const NAMED: usize = 8;

/// Compares the hull with every mask; names the photographs that do not fit.
pub fn check(found: &Found, mesh: &TriMesh) -> Vec<Agreement> {
    let all: Vec<Agreement> = found.views.par_iter().map(|v| v.agreement(mesh)).collect();
    let mut worst: Vec<usize> = (0..all.len()).filter(|k| all[*k].missed > MISSED).collect();
    worst.sort_by(|a, b| all[*b].missed.total_cmp(&all[*a].missed));
    for k in worst.iter().take(NAMED) {
        cli::warn(&format!(
            "{}: the other silhouettes exclude {} % of its mask: check its place in the order, its pose, and its mask",
            found.names[*k],
            percent(all[*k].missed)
        ));
    }
    if worst.len() > NAMED {
        cli::warn(&format!(
            "{} more photographs do not fit: check the turntable or the poses",
            worst.len() - NAMED
        ));
    }
    all
}

/// A share in percent, to a tenth.
pub fn percent(share: f64) -> Shown {
    Shown((1000.0 * share).round() / 10.0)
}

/// Warns when nothing gives the scale.
pub fn scale(args: &Args, length: f64) {
    if args.poses.is_some() && args.length.is_none() && args.tag_size.is_none() {
        cli::warn(&format!(
            "lengths are in the unit of the poses (the stone is {} long): give --length with the length of the stone, or --tag-size, if they are not metres",
            Shown(length)
        ));
    }
}

/// What --adjust has changed.
pub fn adjusted(from: &Turntable, to: &Turntable, done: &Adjustment) -> String {
    let shown = |value: f64| Shown((1000.0 * value).round() / 1000.0);
    let mut changes = Vec::new();
    let mut change = |name: &str, a: f64, b: f64, unit: &str| {
        if (b - a).abs() > 1e-3 {
            changes.push(format!("{name} {} → {}{unit}", shown(a), shown(b)));
        }
    };
    change("focal length", from.camera.focal_px, to.camera.focal_px, " px");
    if let (Some(size), Some([x, y])) = (to.camera.size_px, to.camera.centre_px) {
        let (_, [u, v]) = from.frame(size.map(|s| s as usize));
        change("axis at x", u, x, " px");
        change("centre at y", v, y, " px");
    }
    for (k, (a, b)) in from.ring.iter().zip(&to.ring).enumerate() {
        let name = |key: &str| format!("[[ring]] {}: {key}", k + 1);
        change(&name("tilt"), a.tilt_deg, b.tilt_deg, "°");
        change(&name("step"), a.step_deg, b.step_deg, "°");
        change(&name("start"), a.start_deg, b.start_deg, "°");
    }
    format!(
        "; adjusted: {}, after which rays along silhouettes miss the hull by {} % of what they did",
        if changes.is_empty() { "nothing".to_owned() } else { changes.join(", ") },
        percent(done.after / done.before)
    )
}

/// The comment of the file.
pub fn comment(refined: bool) -> String {
    let words = if refined {
        "visual hull, refined by correlation"
    } else {
        "visual hull: an upper bound of the stone"
    };
    words.to_owned()
}

/// One line on the hull.
pub fn summary(
    mesh: &TriMesh,
    agreement: &[Agreement],
    found: &Found,
    refinement: Option<&Refinement>,
) -> String {
    let mean = agreement.iter().map(|a| a.union).sum::<f64>() / agreement.len() as f64;
    let turned = found.aligned.map_or(String::new(), |[overlap, _]| {
        format!("; both places of the stone overlap by {} %", percent(overlap))
    });
    let kind = match refinement {
        None => "upper bound".to_owned(),
        Some(r) => format!("refined: photographs agree on {} % of the surface", percent(r.agreed)),
    };
    format!(
        "hull of {} photographs: {} m³ ({kind}), {} faces; it covers the masks by {} % on average (intersection over union){turned}",
        found.views.len(),
        Shown(mesh.volume()),
        mesh.faces.len(),
        percent(mean)
    )
}

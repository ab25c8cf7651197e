//! What is said about a hull.

use crate::args::Args;
use crate::views::Found;
use geom::Shown;
use geom::mesh::TriMesh;
use photos::adjusted::Adjustment;
use photos::coherence::Ball;
use photos::hull::Agreement;
use photos::refine::Refinement;
use photos::{Turntable, View};
use rayon::prelude::*;
use std::ops::Range;

/// A mask that the hull covers less is doubtful.
const MISSED: f64 = 0.03;
/// Photographs that are named.
const NAMED: usize = 8;

/// Compares the hull with every mask; names the photographs that do not fit. `scale` is a metre over the unit of the poses.
pub fn check(found: &Found, mesh: &TriMesh, cells: usize, scale: f64) -> Vec<Agreement> {
    let all: Vec<Agreement> = found.views.par_iter().map(|v| v.agreement(mesh)).collect();
    let mut worst: Vec<usize> = (0..all.len()).filter(|k| all[*k].missed > MISSED).collect();
    let suspects = if worst.is_empty() { Vec::new() } else { suspects(found, mesh) };
    if !suspects.is_empty() {
        blame(found, mesh, &suspects, (cells, scale));
        return all;
    }
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

/// Photographs that do not agree with most others of their side, two by two.
fn suspects(found: &Found, mesh: &TriMesh) -> Vec<usize> {
    let (low, high) = geom::grid::bounds(&mesh.vertices);
    let ball = Ball { centre: (low + high) / 2.0, radius: (high - low).norm() };
    let (first, second) = found.views.split_at(found.turned_from.min(found.views.len()));
    let second = photos::suspects::suspects(second, &ball).into_iter().map(|k| k + first.len());
    photos::suspects::suspects(first, &ball).into_iter().chain(second).collect()
}

/// The other views; a stone that was turned over is laid back again.
fn without(found: &Found, suspects: &[usize]) -> Vec<View> {
    let side = |of: Range<usize>| -> Vec<View> {
        of.filter(|k| !suspects.contains(k)).map(|k| found.views[k].clone()).collect()
    };
    let (mut first, second) = (side(0..found.turned_from), side(found.turned_from..found.views.len()));
    let back = found.aligned.and_then(|_| photos::align(&first, &second).ok());
    first.extend(back.map_or(second.clone(), |back| back.place.views(&second)));
    first
}

/// Names photographs that alone make the others look wrong, and what they cost.
fn blame(found: &Found, mesh: &TriMesh, suspects: &[usize], (cells, scale): (usize, f64)) {
    let names: Vec<&str> = suspects.iter().map(|k| found.names[*k].as_str()).collect();
    let shown = names.iter().take(NAMED).copied().collect::<Vec<_>>().join(", ");
    let more = if names.len() > NAMED { format!(" and {} more", names.len() - NAMED) } else { String::new() };
    let without = photos::hull(&without(found, suspects), cells).map_or(String::new(), |(other, _)| {
        let [with, without] = [mesh, &other].map(|hull| hull.volume() * scale.powi(3));
        let share = percent(with / without - 1.0);
        format!("; the volume is {} m³ with and {} m³ without them ({share} %)", Shown(with), Shown(without))
    });
    cli::warn(&format!(
        "{shown}{more}: their silhouettes do not agree with most others: check their order, whether one before them is missing, their poses, and \
         their masks{without}: the hull is no upper bound"
    ));
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

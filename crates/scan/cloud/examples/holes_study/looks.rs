//! Shadows that a scanner leaves: how much of their fill is where it looked through.

use crate::scanner::{EYE, Label, STEP, hit, scan};
use cloud::Cloud;
use cloud::fill::Settings;
use geom::Vec3;
use std::fmt::Write as _;
use stream::Table;

/// A point is in front of what was seen if that is so many spacings of the scan behind it.
const MARGIN: f64 = 3.0;

/// A table: nothing known, between two surfaces as well, and with the viewpoint.
///
/// # Errors
/// A cloud that cannot be filled.
pub fn table() -> Result<String, String> {
    let (points, labels) = scan();
    let clean = points.iter().zip(labels).filter(|(_, label)| !matches!(label, Label::Mixed | Label::Bush));
    let points: Vec<Vec3> = clean.map(|(p, _)| *p).collect();
    let mut table = "| option | points added | in space that the scanner looked through | in shadow or unseen |\n|---|---|---|---|\n".to_owned();
    let settings = [
        ("none", Settings::default()),
        ("`--bridge`", Settings { bridge: true, ..Settings::default() }),
        ("`--seen-from`", Settings { seen_from: vec![EYE], ..Settings::default() }),
    ];
    for (name, settings) in settings {
        let cloud =
            Cloud { attributes: Table::with_rows(points.len()), points: points.clone(), ..Cloud::default() };
        let filled = cloud::fill(cloud, &settings).map_err(|why| why.to_string())?;
        let added = &filled.cloud.points[points.len()..];
        let is_free = |p: &&Vec3| {
            let range = (*p - EYE).norm();
            hit(&((*p - EYE) / range)).is_some_and(|(seen, _)| seen > range + MARGIN * STEP * range)
        };
        let free = added.iter().filter(is_free).count();
        let share = 100.0 * free as f64 / added.len().max(1) as f64;
        let _ =
            writeln!(table, "| {name} | {} | {free} ({share:.1} %) | {} |", added.len(), added.len() - free);
    }
    Ok(table)
}

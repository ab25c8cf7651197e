//! What other programs make of the same holes, where GRAINPIPE_PEERS names a Python that has them.

use crate::bodies::{BODIES, Body};
use crate::cuts::{self, Cut, Score};
use crate::page::median;
use cloud::Cloud;
use geom::Vec3;
use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;
use stream::Table;

/// The names in the table, ours first.
const NAMES: [&str; 5] = [
    "cloud-fill",
    "Open3D: Poisson",
    "Open3D: ball pivoting",
    "pymeshlab: Poisson",
    "pymeshlab: ball pivoting",
];
/// A hole counts as filled if the added points are at most so many spacings from all that were cut.
const FILLED: f64 = 5.0;
/// The set of cuts that is compared: one that is kept out of tuning.
const SET: u64 = 2;

/// A table of all bodies; none without the other programs.
///
/// # Errors
/// A peer that fails, a file that cannot be written.
pub fn table(folder: &Path, script: &Path, count: usize) -> Result<Option<String>, String> {
    let Ok(python) = std::env::var("GRAINPIPE_PEERS") else {
        eprintln!("holes_study: peers: left out, GRAINPIPE_PEERS names no Python with open3d and pymeshlab");
        return Ok(None);
    };
    let mut table = format!(
        "| cut out of | {} | best of the peers is better than cloud-fill |\n|{}\n",
        NAMES.join(" | "),
        "---|".repeat(7)
    );
    let mut all = (0, 0);
    for (name, body) in BODIES {
        if matches!(body, Body::Scan(_)) && !folder.is_dir() {
            continue;
        }
        let scores = scores(body, folder, script, &python, count)?;
        let cells: Vec<String> = scores.iter().map(|of| cell(of)).collect();
        let rms = |peer: &[Score], k: usize| filled(&peer[k]).and_then(Score::rms);
        let wins = |k: &usize| {
            let best = scores[1..].iter().filter_map(|peer| rms(peer, *k)).fold(f64::INFINITY, f64::min);
            rms(&scores[0], *k).is_none_or(|own| best < own) && best.is_finite()
        };
        let lost = (0..scores[0].len()).filter(wins).count();
        all = (all.0 + lost, all.1 + scores[0].len());
        let _ = writeln!(table, "| {name} | {} | {lost} of {} |", cells.join(" | "), scores[0].len());
    }
    let _ = writeln!(table, "| all of these | | | | | | {} of {} |", all.0, all.1);
    Ok(Some(table))
}

fn filled(score: &Score) -> Option<&Score> {
    (score.hausdorff <= FILLED).then_some(score)
}

/// Median RMS of the holes that are filled, and how many are.
fn cell(scores: &[Score]) -> String {
    let some = || scores.iter().filter_map(filled);
    let rms = median(some().filter_map(Score::rms));
    if rms.is_nan() {
        format!("– (0 of {})", scores.len())
    } else {
        format!("{rms:.2} ({} of {})", some().count(), scores.len())
    }
}

/// Scores of all programs, by hole.
fn scores(
    body: Body,
    folder: &Path,
    script: &Path,
    python: &str,
    count: usize,
) -> Result<Vec<Vec<Score>>, String> {
    let points = body.points(SET + 1, folder)?;
    let (points, cuts) = cuts::cut(&points, count, SET);
    let cuts: Vec<Cut> = cuts.into_iter().filter(|c| 2.0 * c.radius >= 8.0 * c.spacing).collect();
    let added = cuts::fill(points.clone())?.cloud.points.split_off(points.len());
    let mut inside = vec![vec![Vec::new(); cuts.len()]; NAMES.len()];
    for (k, cut) in cuts.iter().enumerate() {
        inside[0][k] = added.iter().filter(|p| (*p - cut.centre).norm() < cut.radius).copied().collect();
    }
    for (peer, cut, p) in ask(&points, &cuts, script, python)? {
        inside[peer][cut].push(p);
    }
    let of = |points: &Vec<Vec<Vec3>>| {
        cuts.iter().zip(points).map(|(cut, some)| Score::of(body, cut, some, true)).collect()
    };
    Ok(inside.iter().map(of).collect())
}

/// What the script says: which peer puts which points into which cut [m].
fn ask(
    points: &[Vec3],
    cuts: &[Cut],
    script: &Path,
    python: &str,
) -> Result<Vec<(usize, usize, Vec3)>, String> {
    let place = std::env::temp_dir().join(format!("holes-study-{}", std::process::id()));
    let fail = |what: &str, why: &dyn std::fmt::Display| format!("{}: {what}: {why}", place.display());
    std::fs::create_dir_all(&place).map_err(|e| fail("cannot create", &e))?;
    let [cloud, list, out] = ["cloud.ply", "cuts.csv", "out.csv"].map(|name| place.join(name));
    let whole = Cloud {
        attributes: Table::with_rows(points.len()),
        points: points.to_vec(),
        double: true,
        ..Cloud::default()
    };
    let file = std::fs::File::create(&cloud).map_err(|e| fail("cannot write", &e))?;
    cloud::write_ply(&mut std::io::BufWriter::new(file), &whole, stream::ply::Encoding::BinaryLittleEndian)
        .map_err(|e| fail("cannot write", &e))?;
    let line = |c: &Cut| format!("{},{},{},{},{}\n", c.centre.x, c.centre.y, c.centre.z, c.radius, c.spacing);
    let text: String = cuts.iter().map(line).collect();
    std::fs::write(&list, format!("x,y,z,radius,spacing\n{text}")).map_err(|e| fail("cannot write", &e))?;
    let status = Command::new(python)
        .arg(script)
        .args([&cloud, &list, &out])
        .status()
        .map_err(|e| fail(python, &e))?;
    if !status.success() {
        return Err(fail(&script.display().to_string(), &status));
    }
    let text = std::fs::read_to_string(&out).map_err(|e| fail("cannot read", &e))?;
    let _ = std::fs::remove_dir_all(&place);
    let read = |line: &str| {
        let known = parsed(line).filter(|(_, cut, _)| *cut < cuts.len());
        known.ok_or_else(|| fail("cannot read the line", &line))
    };
    text.lines().map(read).collect()
}

/// A line of the script: which peer, which cut, and a point [m].
fn parsed(line: &str) -> Option<(usize, usize, Vec3)> {
    let words: Vec<&str> = line.split(',').collect();
    let [name, cut, x, y, z] = words[..] else { return None };
    let peer = NAMES.iter().position(|n| *n == name)?;
    Some((peer, cut.parse().ok()?, Vec3::new(x.parse().ok()?, y.parse().ok()?, z.parse().ok()?)))
}

//! Cost: one upstream stage and ten tilts of the chute, against ten undivided plants, in processor time.

use crate::page::{put, table};
use crate::plant::scenes;
use crate::shell::{line, timed};
use std::path::Path;

/// Tilts of the chute [deg].
const TILTS: [u32; 10] = [31, 33, 35, 37, 39, 41, 43, 45, 47, 49];

/// Runs both ways and writes the part "cost" of the page.
///
/// # Errors
/// A run that fails, a page that cannot be written.
pub fn study(folder: &Path, page: &Path) -> Result<(), String> {
    let scenes = scenes();
    let scene =
        std::fs::read_to_string(scenes.join("small.toml")).map_err(|why| format!("small.toml: {why}"))?;
    let place = scenes.canonicalize().map_err(|why| format!("{}: {why}", scenes.display()))?;
    let scene =
        scene.replace("\"small-", &format!("\"{}/small-", place.display())).replace("contacts = true\n", "");
    let quiet = "--threads 1 -q";
    let mut times: [Vec<f64>; 3] = Default::default();
    let (mut upstream, mut record) = (0.0, (0u64, 0u64));
    for (k, tilt) in TILTS.into_iter().enumerate() {
        let chute = folder.join(format!("chute-{tilt}.ply"));
        let geometry =
            format!("{}/geometry.sh chute scale=0.35 low=-0.008 high=0.008 tilt={tilt}", place.display());
        line(folder, &format!("{geometry} > chute-{tilt}.ply"))?;
        let own =
            scene.replace(&format!("{}/small-chute.ply", place.display()), &chute.display().to_string());
        std::fs::write(folder.join("plant.toml"), own).map_err(|why| format!("plant.toml: {why}"))?;
        for keep in ["upstream", "downstream"] {
            line(
                folder,
                &format!(
                    "stage-split plant.toml --at 0,0,0.21,0,0,-1 --length 0.006 --keep {keep} -o {keep}.toml -q"
                ),
            )?;
        }
        if k == 0 {
            upstream = timed(folder, &format!("dem-run upstream.toml {quiet} -o up.mcap"))?;
        }
        times[0].push(timed(folder, &format!("dem-run plant.toml {quiet} -o whole.mcap"))?);
        times[1].push(timed(folder, "stage-replay up.mcap --keep-times -o in.mcap -q")?);
        times[2].push(timed(folder, &format!("dem-run downstream.toml in.mcap {quiet} -o down.mcap"))?);
        let size = |name: &str| std::fs::metadata(folder.join(name)).map_or(0, |m| m.len());
        record = (size("up.mcap"), size("in.mcap"));
    }
    put(folder, page, "cost", &text(upstream, &times, record))
}

fn text(upstream: f64, times: &[Vec<f64>; 3], record: (u64, u64)) -> String {
    let sums = [0, 1, 2].map(|k| times[k].iter().sum::<f64>());
    let n = TILTS.len() as f64;
    let staged = upstream + sums[1] + sums[2];
    let row = |what: &str, each: f64, count: f64| {
        vec![what.to_owned(), format!("{each:.2} s"), format!("{count:.0}"), format!("{:.1} s", each * count)]
    };
    let rows = [
        row("undivided, A + B", sums[0] / n, n),
        row("upstream stage with its record, A", upstream, 1.0),
        row("replay of the record", sums[1] / n, n),
        row("downstream stage, B", sums[2] / n, n),
        vec!["in stages, together".into(), String::new(), String::new(), format!("{staged:.1} s")],
    ];
    let cells = table(&["processor time", "each", "runs", "together"], &rows);
    let split = upstream + (sums[1] + sums[2]) / n;
    let formula = (upstream + sums[2]) / (n * (upstream + sums[2] / n));
    format!(
        "{cells}\nTen tilts in stages take {:.0} % of the processor time of ten undivided runs. By A·X + B·X·Y against (A + B)·X·Y with A and B as \
         measured it would be {:.0} %;\nwith the source's A = 10 and B = 2, 25 %. One variant alone, in two stages, takes {:.0} % of an undivided run: what cutting itself \
         costs or saves. Record and\nreplay: {:.1} % of the time in stages; the upstream run is a file of {} kB, its inlet of {} kB.\n",
        100.0 * staged / sums[0],
        100.0 * formula,
        100.0 * split / (sums[0] / n),
        100.0 * sums[1] / staged,
        record.0 / 1000,
        record.1 / 1000,
    )
}

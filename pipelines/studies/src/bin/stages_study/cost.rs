//! Cost: one upstream stage and ten tilts of the chute, against ten undivided plants, on the clock and in processor time.
//!
//! The plant is the small one under a hopper that holds five times as much, of which less than a third flows out: what lies before the cut is
//! then most of it, as in the plants that the source has in mind.

use crate::page::{SMALL, put, table};
use crate::plant::scenes;
use crate::shell::{Took, line, timed};
use std::path::Path;

/// Tilts of the chute [deg].
const TILTS: [u32; 10] = [31, 33, 35, 37, 39, 41, 43, 45, 47, 49];

/// What the plant has instead of the small one's text.
const LARGER: [(&str, &str); 5] = [
    ("0.0415,0.008,0.375", "0.0415,0.008,0.72"),
    ("mass = 0.07 ", "mass = 0.35 "),
    ("until = 1.2 ", "until = 0.5 "),
    ("contacts = true\n", ""),
    ("every = 0.01 ", "every = 0.05 "),
];

/// Runs both ways and writes the part "cost" of the page.
///
/// # Errors
/// A run that fails, a page that cannot be written.
pub fn study(folder: &Path, page: &Path) -> Result<(), String> {
    let place = scenes().canonicalize().map_err(|why| format!("{}: {why}", scenes().display()))?;
    let place = place.display();
    let scene = plant(&place.to_string(), folder)?;
    let quiet = "--threads 1 -q";
    let mut times: [Vec<Took>; 3] = Default::default();
    let (mut upstream, mut record) = (Took::default(), (0u64, 0u64));
    for (k, tilt) in TILTS.into_iter().enumerate() {
        let geometry = format!("{place}/geometry.sh chute scale=0.35 low=-0.008 high=0.008 tilt={tilt}");
        line(folder, &format!("{geometry} > chute.ply"))?;
        std::fs::write(folder.join("plant.toml"), &scene).map_err(|why| format!("plant.toml: {why}"))?;
        for keep in ["upstream", "downstream"] {
            let cut = "--at 0,0,0.21,0,0,-1 --length 0.006";
            line(folder, &format!("stage-split plant.toml {cut} --keep {keep} -o {keep}.toml -q"))?;
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
    put(folder, page, ("cost", SMALL), &text(upstream, &times, record))
}

/// The scene of the plant; its hopper is drawn into the folder, where its chute is to be, too.
fn plant(place: &str, folder: &Path) -> Result<String, String> {
    let small =
        std::fs::read_to_string(scenes().join("small.toml")).map_err(|why| format!("small.toml: {why}"))?;
    let hopper = "hopper scale=0.35 mouth=0.03 low=-0.008 high=0.008 shaft=1.4";
    line(folder, &format!("{place}/geometry.sh {hopper} > hopper.ply"))?;
    let mut scene = small
        .replace("\"small-hopper.ply\"", "\"hopper.ply\"")
        .replace("\"small-chute.ply\"", "\"chute.ply\"")
        .replace("\"small-box.ply\"", &format!("\"{place}/small-box.ply\""));
    for (from, to) in LARGER {
        if !scene.contains(from) {
            return Err(format!("small.toml has no '{from}' any more"));
        }
        scene = scene.replace(from, to);
    }
    Ok(scene)
}

/// Both times of a sum.
fn sum(times: &[Took]) -> Took {
    let of = |pick: fn(&Took) -> f64| times.iter().map(pick).sum::<f64>();
    Took { wall: of(|t| t.wall), processor: of(|t| t.processor) }
}

fn text(upstream: Took, times: &[Vec<Took>; 3], record: (u64, u64)) -> String {
    let sums = [0, 1, 2].map(|k| sum(&times[k]));
    let n = TILTS.len() as f64;
    let staged = sum(&[upstream, sums[1], sums[2]]);
    let row = |what: &str, all: Took, count: f64| {
        let each = format!("{:.2} s", all.wall / count);
        let [wall, processor] = [all.wall, all.processor].map(|t| format!("{t:.1} s"));
        vec![what.to_owned(), each, format!("{count:.0}"), wall, processor]
    };
    let mut together = row("**in stages, together**", staged, 1.0);
    (together[1], together[2]) = (String::new(), String::new());
    let rows = [
        row("**undivided, (A + B)·X·Y**", sums[0], n),
        row("upstream stage with its record, A", upstream, 1.0),
        row("replay of the record", sums[1], n),
        row("downstream stage, B", sums[2], n),
        together,
    ];
    let cells = table(&["", "each, on the clock", "runs", "all, on the clock", "processor time"], &rows);
    let split = upstream.processor + (sums[1].processor + sums[2].processor) / n;
    let formula =
        (upstream.processor + sums[2].processor) / (n * (upstream.processor + sums[2].processor / n));
    format!(
        "{cells}\nX = 1 upstream variant, Y = 10 downstream variants; one thread each, one after the other, \
         on a machine with other work. Ten tilts in stages take {:.0} % of the processor time of ten \
         undivided runs ({:.0} % on the clock). The formula A·X + B·X·Y over (A + B)·X·Y gives {:.0} % with \
         the measured A and B. Here A is {:.1} times B; in the source document it is 5 times, which gives 25 \
         %. One variant alone takes {:.0} % of an undivided run in two stages: this is the cost or saving of \
         the cut itself. Record and replay take {:.1} % of the time in stages. The upstream run is a file of \
         {} kB, its inlet one of {} kB.\n",
        100.0 * staged.processor / sums[0].processor,
        100.0 * staged.wall / sums[0].wall,
        100.0 * formula,
        upstream.processor / (sums[2].processor / n),
        100.0 * split / (sums[0].processor / n),
        100.0 * sums[1].processor / staged.processor,
        record.0 / 1000,
        record.1 / 1000,
    )
}

//! Errors: what cannot be measured, and the remedy.

use geom::Shown;
use thiserror::Error;

/// Why something could not be measured.
#[derive(Debug, Error, PartialEq)]
pub enum MeasureError {
    #[error("run holds no {what}: {cure}")]
    Channel { topic: &'static str, what: &'static str, cure: &'static str },
    #[error("{topic}: the column '{column}' is missing; it has {}: write the run with dem-run", has.join(", "))]
    Column { topic: String, column: String, has: Vec<String> },
    #[error(
        "{topic} at {} s: row {row}: {column} = {value} is {wrong}: the run is damaged here; measure the part before it with --until",
        Shown(*time)
    )]
    Value { topic: String, time: f64, row: usize, column: String, value: f64, wrong: &'static str },
    #[error("{topic} at {} s: {why}: write the run again", Shown(*time))]
    Message { topic: String, time: f64, why: String },
    #[error(
        "run has {frames} frame{}: {what} needs two: set [output] every to less, or run longer",
        if *frames == 1 { "" } else { "s" }
    )]
    OneFrame { what: &'static str, frames: u64 },
    #[error("run has no frame {}: its frames are from {} to {} s", wanted, Shown(*first), Shown(*last))]
    NoFrame { wanted: String, first: f64, last: f64 },
    #[error("shape has a volume of {} m³: give a larger shape", Shown(*volume))]
    EmptyShape { volume: f64 },
    #[error(
        "shape is infinite, so it has no volume: give a box, sphere, cylinder, cone, prism or mesh, without !"
    )]
    EndlessShape,
    #[error(
        "all: everything has a volume only in a domain that is periodic along x, y and z, and this one has no end along {axis}: \
         give a box, sphere, cylinder, cone, prism or mesh"
    )]
    EndlessDomain { axis: &'static str },
    #[error(
        "no {what} in the shape at any time: the grains are in box:{}: move the shape",
        corners(low, high)
    )]
    NothingInside { what: &'static str, low: [f64; 3], high: [f64; 3] },
    #[error(
        "frames hold at most {most} grains, and {what} needs {wanted}: run longer, or choose other frames"
    )]
    FewGrains { what: &'static str, most: usize, wanted: usize },
    #[error("no frame has a grain with id {ids}: give ids from {} to {}", known[0], known[1])]
    NoSuchGrain { ids: String, known: [u64; 2] },
    #[error("frame at {} s holds no grains: choose another time with --time", Shown(*time))]
    NoGrains { time: f64 },
    #[error(
        "material {index} has no density in this run, so its grains have no mass: give [[material]] density"
    )]
    Density { index: u16 },
    #[error("no field '{name}' in /particles; it has {}", has.join(", "))]
    Field { name: String, has: Vec<String> },
    #[error(
        "heap at {} s: {part} has {found} profile bins between {} and {} of its height {} m, and 3 are needed: \
         {}give smaller --bin (now {} m), wider --fractions or fewer --sectors",
        Shown(*time), Shown(fractions[0]), Shown(fractions[1]), Shown(*height), above(*overhang), Shown(*bin)
    )]
    SmallHeap {
        time: f64,
        part: String,
        found: usize,
        fractions: [f64; 2],
        height: f64,
        bin: f64,
        overhang: Option<f64>,
    },
    #[error("{what} = {}: {cure}", format!("{} {unit}", Shown(*value)).trim_end())]
    Setting { what: &'static str, value: f64, unit: &'static str, cure: &'static str },
    #[error("{what}: {count} cells are more than {most}: give fewer bins, or a larger --cell")]
    Cells { what: &'static str, count: f64, most: f64 },
    #[error(
        "{} s hold more than {most} spans of {} s: give a --span of at least {} s",
        Shown(*length), Shown(*span), Shown(length / most)
    )]
    Spans { span: f64, length: f64, most: f64 },
    #[error(
        "the frames are {} s long, and one span of {} s does not fit: give a shorter --span, or run longer",
        Shown(length.max(0.0)), Shown(*span)
    )]
    LongSpan { span: f64, length: f64 },
    #[error("there is only one kind of grains ({kind}): {cure}")]
    OneKind { kind: String, cure: &'static str },
    #[error(
        "run holds forces on whole walls only (/wall_forces), and a part of them is asked for: give --wall-force all, \
         with --wall NAME for one wall, or set [output] contacts = true and run again"
    )]
    WholeWalls,
    #[error(
        "--wear-coefficient: no material '{name}' in this run; there are {}: give the name of one, or K alone for all",
        has.join(", ")
    )]
    Material { name: String, has: Vec<String> },
    #[error("no material '{name}'; there are {}: give one of these names", has.join(", "))]
    Name { name: String, has: Vec<String> },
    #[error(
        "--wall: no wall '{name}' in this run; by number and name there are {}: give one of these",
        numbered(has)
    )]
    Wall { name: String, has: Vec<String> },
}

/// `0 floor, 1 lid`.
fn numbered(names: &[String]) -> String {
    let all: Vec<String> = names.iter().enumerate().map(|(k, name)| format!("{k} {name}")).collect();
    all.join(", ")
}

/// Grains above the heap are the likelier cause.
fn above(overhang: Option<f64>) -> String {
    overhang.map_or_else(String::new, |share| {
        let percent = (100.0 * share).round();
        format!(
            "over {percent} % of the area grains stand above a gap of more than 4 diameters: measure the part below them \
             with --within SHAPE; else "
        )
    })
}

fn corners(low: &[f64; 3], high: &[f64; 3]) -> String {
    low.iter().chain(high).map(|v| Shown(*v).to_string()).collect::<Vec<_>>().join(",")
}

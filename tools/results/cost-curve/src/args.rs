//! The command line.

use anyhow::Context;
use clap::Parser;
use cli::{OutPath, usage};
use curve::{Study, TrueValue, Wanted};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

const NOTES: &str = "KEY: any key of the scene (as for dem-run --set; * is every entry of a list: material.*.young), or safety, dt, \
    accuracy, stiffness (a factor on every young and stiffness), young, precision, skin, sleep, every, zone, threads. \
    {KEY} in SCENE, an INPUT or --each is replaced by the value of KEY, {seed} by the seed.\n\
    NAME: heap-angle, discharge-rate PLANE, wall-force SHAPE, peak-wall-force SHAPE, energy-error, contact-time, overlap, \
    restitution, velocity-profile, packing-fraction SHAPE, bed-height, each with further options of dem-measure; or \
    'VALUE of --MEASURE …': any value of its summary, or any of its columns as a profile \
    ('each VALUE of …' where both have it).\n\
    Points run one after another: other work on the machine, and --jobs, disturb the times.\n\
    docs/evidence/accuracy.md explains errors and costs, and has examples.\n\n\
    Examples:\n\
    \x20 cost-curve scene.toml --vary safety=0.2,0.4 --measure bed-height --for 1% -o curve.svg\n\
    \x20 cost-curve scene.toml --vary safety=0.2,0.4 --measure bed-height --dry-run";

/// Show what accuracy costs in time: run a scene over a grid of settings; CSV to stdout, a plot, a recommended setting
#[derive(Parser, Debug)]
#[command(after_help = NOTES)]
pub struct Args {
    /// The scene (TOML)
    #[arg(value_name = "SCENE.toml")]
    pub scene: String,
    /// Walls and inlets of every point
    #[arg(value_name = "INPUT")]
    pub inputs: Vec<String>,
    /// Values of a key; the grid is every combination (repeat)
    #[arg(long, value_name = "KEY=A,B,C", required = true, allow_hyphen_values = true)]
    pub vary: Vec<String>,
    /// The measure (NAME below), computed by dem-measure
    #[arg(long, value_name = "NAME", allow_hyphen_values = true)]
    pub measure: String,
    /// Change a key of the scene in every point (repeat)
    #[arg(long, value_name = "KEY=VALUE", allow_hyphen_values = true)]
    pub set: Vec<String>,
    /// A shell line that makes one more input of each point, such as 'bluenoise-sample scan.ply --spacing {spacing} | wallgen …';
    /// a line that prints nothing adds no input
    #[arg(long, value_name = "LINE")]
    pub each: Option<String>,
    /// The setting that errors are measured from (default: the finest of each key)
    #[arg(long, value_name = "KEY=V", conflicts_with_all = ["exact", "laboratory"], help_heading = "Judging")]
    pub reference: Vec<String>,
    /// The exact value, in the unit of the measure
    #[arg(long, value_name = "VALUE", value_parser = geom::number::finite, allow_hyphen_values = true, conflicts_with = "laboratory", help_heading = "Judging")]
    pub exact: Option<f64>,
    /// A value from a laboratory, and the half width of its 95 % interval
    #[arg(long, value_name = "VALUE[,U]", value_parser = laboratory, allow_hyphen_values = true, help_heading = "Judging")]
    pub laboratory: Option<(f64, f64)>,
    /// The setting in use of a key that the scene does not contain, such as a {KEY} (repeat)
    #[arg(long, value_name = "KEY=V", help_heading = "Judging")]
    pub in_use: Vec<String>,
    /// Recommend the cheapest setting within this error: a share (1%), or a number in its unit where the exact value is 0 (default 1%)
    #[arg(long = "for", value_name = "ERROR", value_parser = wanted, allow_hyphen_values = true, help_heading = "Judging")]
    pub wanted: Option<Wanted>,
    /// How a profile becomes one number [default: rms]
    #[arg(long, value_enum, help_heading = "Judging")]
    pub norm: Option<Norm>,
    /// Run each point with N seeds of the random numbers; gives the mean and its 95 % interval
    #[arg(long, value_name = "N", default_value_t = 1, help_heading = "Running")]
    pub repeat: u64,
    /// Run each point at N phases of the step, with steps up to 5 % shorter; the worst error counts (default: 8 where the scene uses no random
    /// numbers, else 1)
    #[arg(long, value_name = "N", conflicts_with = "repeat", help_heading = "Running")]
    pub phases: Option<u64>,
    /// Run everything N times, in turn; the median time counts
    #[arg(long, value_name = "N", default_value_t = 1, help_heading = "Running")]
    pub rounds: u64,
    /// What a run costs
    #[arg(long, value_enum, default_value_t = Work::Seconds, help_heading = "Running")]
    pub work: Work,
    /// Points that run at the same time; they disturb each other's times
    #[arg(long, value_name = "N", default_value = "1", help_heading = "Running")]
    pub jobs: NonZeroUsize,
    /// Folder for the points, each with its run and report; finished points are reused (default: beside the plot)
    #[arg(long, value_name = "DIR", help_heading = "Running")]
    pub dir: Option<OutPath>,
    /// Run nothing: write a script for each point that is not finished, and print a line to run each
    #[arg(long, visible_alias = "dry-run", help_heading = "Running")]
    pub print_commands: bool,
    /// Also write the result in sentences to FILE.md (Markdown)
    #[arg(long, value_name = "FILE.md")]
    pub words: Option<OutPath>,
    /// The plot: work over error
    #[arg(id = "output", short = 'o', long = "output", value_name = "FILE.svg|png")]
    pub plot: Option<OutPath>,
}

/// What a run costs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Work {
    /// Wall time for each simulated second
    Seconds,
    /// Processor time for each simulated second: other work on the machine hardly disturbs it
    Cpu,
    /// Steps for each simulated second: the same on every machine
    Steps,
    /// Instructions of the program for each simulated second; needs perf or valgrind
    Instructions,
}

/// How a profile becomes one number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Norm {
    /// Root mean square
    Rms,
    /// Largest absolute value
    Max,
}

fn wanted(text: &str) -> Result<Wanted, String> {
    let wrong = || "give a share such as 1%, or a number above 0 in the unit of the measure".to_owned();
    let number = |text: &str| geom::number::positive(text).map_err(|_| wrong());
    match text.strip_suffix('%') {
        Some(share) => Ok(Wanted::Share(number(share)? / 100.0)),
        None => Ok(Wanted::Absolute(number(text)?)),
    }
}

fn laboratory(text: &str) -> Result<(f64, f64), String> {
    let (value, half) = text.split_once(',').unwrap_or((text, "0"));
    let number = |text: &str| geom::number::finite(text).ok();
    match (number(value), number(half)) {
        (Some(value), Some(half)) if half >= 0.0 => Ok((value, half)),
        _ => Err("give a value, and the half width of its interval, such as 35.5,0.8".to_owned()),
    }
}

impl Args {
    /// The study.
    pub fn study(&self) -> Study {
        let exact = self.exact.map(|value| TrueValue { value, half_width: 0.0 });
        let laboratory = self.laboratory.map(|(value, half_width)| TrueValue { value, half_width });
        Study {
            scene: self.scene.clone(),
            inputs: self.inputs.clone(),
            vary: self.vary.clone(),
            set: self.set.clone(),
            each: self.each.clone(),
            reference: self.reference.clone(),
            in_use: self.in_use.clone(),
            truth: exact.or(laboratory),
            wanted: self.wanted,
            norm: if self.norm == Some(Norm::Max) { curve::Norm::Max } else { curve::Norm::Rms },
            repeat: self.repeat,
            phases: self.phases,
            rounds: self.rounds,
            work: match self.work {
                Work::Seconds => curve::Work::Seconds,
                Work::Cpu => curve::Work::Cpu,
                Work::Steps => curve::Work::Steps,
                Work::Instructions => curve::Work::Instructions,
            },
            folder: self.folder(),
            threads: rayon::current_num_threads(),
        }
    }

    /// The folder of the points.
    pub fn folder(&self) -> PathBuf {
        let beside = || self.plot.as_deref().unwrap_or(Path::new("cost-curve")).with_extension("points");
        self.dir.as_deref().map_or_else(beside, Path::to_owned)
    }

    /// Refuses what would only fail after the runs.
    ///
    /// # Errors
    /// Another picture than SVG and PNG, streams that can be read only once, counts of 0.
    pub fn check(&self) -> anyhow::Result<()> {
        if let Some(file) = &self.plot {
            plot::check_name(file).map_err(|e| cli::usage(format!("-o {e}")))?;
        }
        if self.scene == "-" || self.inputs.iter().any(|i| i == "-") {
            return Err(usage("-: every point reads its inputs again: give files"));
        }
        for (option, count) in
            [("--repeat", self.repeat), ("--rounds", self.rounds), ("--phases", self.phases.unwrap_or(1))]
        {
            if !(1..=1000).contains(&count) {
                return Err(usage(format!("{option} {count}: give a number from 1 to 1000")));
            }
        }
        std::fs::create_dir_all(self.folder()).with_context(|| {
            format!("{}: cannot make this folder: choose another --dir", self.folder().display())
        })
    }
}

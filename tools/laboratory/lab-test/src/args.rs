//! The command line.

use anyhow::Context;
use cli::{OutPath, usage};
use lab::Request;

const NOTES: &str = "SAMPLE.toml is a scene without walls, times and outputs: materials, contacts, bonds, and the grains as one [[fill]] \
    without shape and amount, or as packed [[particles]] (of stone-pack, or of a run). Walls are of the materials 'side' (smooth) and 'plate' \
    (as rough as the grains), where the sample defines none of these names.\n\
    docs/how-to/lab-tests.md explains each test, its equations and columns.\n\n\
    Examples:\n\
    \x20 lab-test crush stone.toml --seeds 5 -o curves.csv --plot curves.svg --report crush.json\n\
    \x20 lab-test direct-shear soil.toml --stress '50 kPa' --print-scene\n\
    \x20 lab-test triaxial soil.toml --grains 1500 --print-preparation -o prepare.toml\n\
    \x20 lab-test crush stone.toml --seeds 50 --dir stones --jobs-file jobs.txt";

/// Run a standard laboratory test on a sample of grains: curves as CSV, a plot, a page, and what the curves come to
#[derive(clap::Parser, Debug)]
#[command(after_help = NOTES)]
pub struct Args {
    /// The test
    #[arg(value_name = "TEST", value_enum)]
    pub test: Test,
    /// The sample
    #[arg(value_name = "SAMPLE.toml", default_value = "-")]
    pub sample: cli::Source,
    /// The curves of all specimens (CSV)
    #[command(flatten)]
    pub output: cli::Output,
    /// Stresses [Pa], or with a unit: a specimen for each (oedometer: the path of one; uniaxial: that of the preparation)
    #[arg(long, value_name = "PA,…", value_delimiter = ',', value_parser = stress)]
    pub stress: Vec<f64>,
    /// Change a key of the sample (repeat)
    #[arg(long, value_name = "KEY=VALUE", allow_hyphen_values = true)]
    pub set: Vec<String>,
    /// Size of the specimen [m]: x; x,z; or x,y,z (a cylinder: diameter; diameter,height; a heap, a drum: diameter)
    #[arg(long, value_name = "M,…", value_delimiter = ',', value_parser = length, conflicts_with = "grains")]
    pub size: Vec<f64>,
    /// Grains of each specimen, about [default: 2000; oedometer: 5000]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(50..=10_000_000))]
    pub grains: Option<u64>,
    /// End of the test: strain, displacement over length, or turns of the drum, such as 0.15 or 15%
    #[arg(long, value_name = "SHARE", value_parser = geom::number::share)]
    pub strain: Option<f64>,
    /// Inertial number that sets the speed of the test [default: 0.001]
    #[arg(long, value_name = "I", value_parser = geom::number::positive, conflicts_with = "speed")]
    pub inertial: Option<f64>,
    /// Speed of the wall that drives the test, or of the stream of a heap [m/s]
    #[arg(long, value_name = "M/S", value_parser = geom::number::positive)]
    pub speed: Option<f64>,
    /// Sliding friction of the grains while the specimen is prepared: 0 makes it dense [default: that of the sample]
    #[arg(long, value_name = "MU", value_parser = geom::number::not_negative)]
    pub friction: Option<f64>,
    /// Mean unbalanced over mean contact force at which a specimen counts as at rest [default: 0.0001; repose and drum: 0.01]
    #[arg(long, value_name = "SHARE", value_parser = geom::number::share)]
    pub rest: Option<f64>,
    /// Rows of each curve
    #[arg(long, value_name = "N", default_value_t = lab::recipes::ROWS, value_parser = clap::value_parser!(u64).range(20..=100_000))]
    pub rows: u64,
    /// Specimens of each stress, with the seeds from --seed on; two and more give intervals
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..=10_000))]
    pub seeds: u64,
    /// Folder for scenes, runs and tables, one for each specimen; what is finished there is used again [default: none is kept]
    #[arg(long, value_name = "DIR")]
    pub dir: Option<OutPath>,
    /// Run nothing while specimens are open: write a shell line for each of them, for parallel, make -j or a batch system; the same command then evaluates them
    #[arg(long, value_name = "FILE", requires = "dir")]
    pub jobs_file: Option<OutPath>,
    /// Run nothing; print the scene of the test, with the specimen as high as it is expected to become
    #[arg(long)]
    pub print_scene: bool,
    /// Run nothing; print the scene of the preparation
    #[arg(long, conflicts_with = "print_scene")]
    pub print_preparation: bool,
    /// Write what the curves come to as a table (Markdown)
    #[arg(long, value_name = "FILE.md")]
    pub words: Option<OutPath>,
    /// Draw the curves
    #[arg(long, value_name = "FILE.svg|png")]
    pub plot: Option<OutPath>,
    /// Write a page with the test of the first specimen in motion
    #[arg(long, value_name = "FILE.html")]
    pub page: Option<OutPath>,
    #[command(flatten)]
    pub seed: cli::Seed,
}

/// A test.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Test {
    /// A box of two halves under a normal stress; the upper half moves
    DirectShear,
    /// A specimen of bonded grains between two plates
    Uniaxial,
    /// A box whose sides hold a stress while the lid comes down
    Triaxial,
    /// A periodic domain without walls that holds a stress along x and y while it is compressed along z
    TriaxialPeriodic,
    /// A box with fixed sides, whose lid follows a path of stresses
    Oedometer,
    /// A cylinder of grains that is lifted off
    Repose,
    /// Grains that are poured onto a round plate
    Heap,
    /// Grains in a drum that turns
    Drum,
    /// A single stone of bonded grains between two plates
    Crush,
}

fn stress(text: &str) -> Result<f64, String> {
    in_unit(text, "Pa", "a stress is above 0 Pa, such as 50000 or '50 kPa'")
}

fn length(text: &str) -> Result<f64, String> {
    in_unit(text, "m", "a length is above 0 m, such as 0.1 or '100 mm'")
}

/// A number above 0, plain or with a unit.
fn in_unit(text: &str, unit: &'static str, such: &str) -> Result<f64, String> {
    let text = text.trim();
    let value = match geom::number::finite(text) {
        Ok(value) => value,
        Err(_) => geom::units::parse(text, unit).map_err(|e| format!("{e}; {such}"))?,
    };
    if value > 0.0 && value.is_finite() { Ok(value) } else { Err(such.to_owned()) }
}

impl Args {
    /// What is asked of the specimens.
    pub fn request(&self) -> Request {
        Request {
            stress: self.stress.clone(),
            size: (!self.size.is_empty()).then(|| self.size.clone()),
            grains: self.grains,
            strain: self.strain,
            inertial: self.inertial,
            speed: self.speed,
            friction: self.friction,
            rest: self.rest,
            rows: self.rows,
        }
    }

    /// The seeds of the specimens.
    pub fn seeds(&self) -> Vec<u64> {
        (0..self.seeds).map(|k| self.seed.seed().wrapping_add(k)).collect()
    }

    /// Name of the test as the library knows it.
    pub fn test(&self) -> anyhow::Result<&'static dyn lab::Recipe> {
        let name =
            clap::ValueEnum::to_possible_value(&self.test).map_or(String::new(), |v| v.get_name().to_owned());
        lab::recipes::find(&name).with_context(|| format!("{name}: no such test"))
    }

    /// The option that prints a scene.
    fn printed(&self) -> Option<&'static str> {
        let given = [("--print-scene", self.print_scene), ("--print-preparation", self.print_preparation)];
        given.into_iter().find(|(_, given)| *given).map(|(option, _)| option)
    }

    /// Refuses what would only fail after the runs.
    pub fn check(&self) -> anyhow::Result<()> {
        if let Some(file) = &self.plot {
            plot::check_name(file).map_err(|e| usage(format!("--plot {e}")))?;
        }
        if let Some(page) = self.page.as_ref().filter(|page| page.extension().is_none_or(|e| e != "html")) {
            return Err(usage(format!("--page {}: use a name that ends in .html", page.display())));
        }
        if self.jobs_file.is_some() && self.sample.path().is_none() {
            return Err(usage("--jobs-file: its lines name the sample: give SAMPLE.toml, not stdin"));
        }
        let Some(printed) = self.printed() else { return Ok(()) };
        let nothing = [
            ("--plot", self.plot.is_some()),
            ("--page", self.page.is_some()),
            ("--words", self.words.is_some()),
            ("--jobs-file", self.jobs_file.is_some()),
            ("--dir", self.dir.is_some()),
        ];
        if let Some((option, _)) = nothing.into_iter().find(|(_, given)| *given) {
            return Err(usage(format!(
                "{option} has no effect with {printed}, which runs nothing: leave it out"
            )));
        }
        let (seeds, rows) = (self.seeds > 1, self.rows != lab::recipes::ROWS);
        let other = match self.print_preparation {
            true => vec![
                ("--strain", self.strain.is_some()),
                ("--inertial", self.inertial.is_some()),
                ("--speed", self.speed.is_some()),
                ("--rows", rows),
                ("--seeds", seeds),
            ],
            false => vec![
                ("--friction", self.friction.is_some()),
                ("--rest", self.rest.is_some()),
                ("--seeds", seeds),
            ],
        };
        match other.into_iter().find(|(_, given)| *given) {
            Some((option, _)) => {
                Err(usage(format!("{option} has no effect on the scene of {printed}: leave it out")))
            }
            None => Ok(()),
        }
    }
}

//! The command line.

use cli::{MaybeFile, OutPath};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "A recipe names parameters with bounds and tests with commands; the output is a table (CSV) of the parameters with intervals.\n\n\
    Examples:\n\
    \x20 calibrate recipe.toml --data shear.csv --jobs 2 --page fit.html -o found.csv\n\
    \x20 calibrate recipe.toml --data shear.csv --jobs-file jobs.txt --dir shared\n\
    \x20 calibrate --guess --material sand --size 2mm --moisture dry --repose-deg 33 -o sand.toml";

/// Find the parameters of a model from measured curves, with intervals
#[derive(clap::Parser)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Parameters, tests, data and settings (TOML)
    #[arg(value_name = "RECIPE.toml")]
    pub recipe: Option<PathBuf>,
    /// Data of a test (CSV), instead of those of the recipe; without TEST=: of the next test without data; several of one test: specimens
    #[arg(long, value_name = "[TEST=]FILE")]
    data: Vec<MaybeFile>,
    /// Folder of the trials; the same command continues there [default: RECIPE.trials]
    #[arg(long, value_name = "DIR")]
    dir: Option<OutPath>,
    /// Runs at the same time [default: all cores]
    #[arg(long, value_name = "N")]
    jobs: Option<NonZeroUsize>,
    /// Judge the trials that are in the folder so far; nothing is run
    #[arg(long, conflicts_with_all = ["jobs", "jobs_file", "run", "guess"])]
    pub so_far: bool,
    /// Do not simulate the best point of each step at the end: what the emulator says of it stays a promise
    #[arg(long, conflicts_with_all = ["run", "guess", "so_far"])]
    pub no_verify: bool,
    /// Write the open runs of the next batch, a command each line, and end
    #[arg(long, value_name = "FILE", conflicts_with_all = ["jobs", "words", "samples", "plot", "page"])]
    pub jobs_file: Option<OutPath>,
    /// Do one run that --jobs-file has listed
    #[arg(long, value_name = "JOB", conflicts_with_all = ["recipe", "data", "dir", "jobs", "jobs_file", "words", "samples", "plot", "page", "design", "seed"])]
    pub run: Option<PathBuf>,
    /// Print starting values for a scene from four answers; those that are not given are asked for on a terminal
    #[arg(long, conflicts_with_all = ["recipe", "data", "dir", "jobs", "jobs_file", "run", "words", "samples", "plot", "page", "design", "seed"])]
    pub guess: bool,
    /// What is it: a name of the table of materials, such as sand
    #[arg(long, value_name = "NAME", requires = "guess", conflicts_with_all = ["recipe", "run"])]
    pub material: Option<String>,
    /// Diameter of its grains, such as "5 mm"
    #[arg(long, value_name = "LENGTH", requires = "guess", conflicts_with_all = ["recipe", "run"])]
    pub size: Option<String>,
    /// How wet it is
    #[arg(long, value_name = "dry|damp|wet", requires = "guess", conflicts_with_all = ["recipe", "run"])]
    pub moisture: Option<String>,
    /// Angle of repose of its heaps [degrees]
    #[arg(long, value_name = "DEG", requires = "guess", conflicts_with_all = ["recipe", "run"])]
    pub repose_deg: Option<String>,
    /// Write the findings as text (Markdown)
    #[arg(long, value_name = "FILE")]
    pub words: Option<OutPath>,
    /// Draw fits, pairs, sensitivities and convergence (SVG or PNG)
    #[arg(long, value_name = "FILE")]
    pub plot: Option<OutPath>,
    /// Write a page with the picture, the findings and the tests (HTML)
    #[arg(long, value_name = "FILE")]
    pub page: Option<OutPath>,
    /// Write what each test would tell next, the most telling first (CSV); tests without data are simulated, too
    #[arg(long, value_name = "FILE")]
    pub design: Option<OutPath>,
    /// Write samples of the posterior (CSV)
    #[arg(long, value_name = "FILE")]
    pub samples: Option<OutPath>,
    #[command(flatten)]
    pub output: cli::Output,
    /// Seed of the proposals, and the first of the runs [default: that of the recipe]
    #[arg(long = "seed", value_name = "N")]
    pub seed: Option<u64>,
}

impl Args {
    /// The recipe's file.
    pub fn recipe(&self) -> anyhow::Result<&Path> {
        self.recipe.as_deref().ok_or_else(|| cli::usage("name a recipe: calibrate RECIPE.toml"))
    }

    /// Refuses names of another format, and files that cannot be written, before anything is run for them.
    ///
    /// # Errors
    /// The first of these.
    pub fn check_names(&self) -> anyhow::Result<()> {
        if let Some(file) = &self.plot {
            plot::check_name(file).map_err(|e| cli::usage(format!("--plot {e}")))?;
        }
        let more = [&self.plot, &self.page, &self.design, &self.samples, &self.words];
        let files = more.into_iter().filter_map(Option::as_deref).chain(self.output.path());
        // A pipe or a device is opened when there is something to write: its reader would take this for the end.
        for file in files.filter(|file| file.metadata().map_or(true, |kind| kind.is_file() || kind.is_dir()))
        {
            drop(cli::OutputStream::file(file)?);
        }
        Ok(())
    }

    /// Data of the tests, as the recipe's reader takes them.
    pub fn data(&self) -> Vec<String> {
        self.data.iter().map(|data| data.text().to_owned()).collect()
    }

    /// Folder of the trials.
    pub fn dir(&self, recipe: &Path) -> PathBuf {
        let beside = || PathBuf::from(recipe.file_stem().unwrap_or_default()).with_extension("trials");
        self.dir.as_deref().map_or_else(beside, Path::to_owned)
    }

    /// Runs at the same time.
    pub fn jobs(&self) -> usize {
        let cores = std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
        self.jobs.map_or(cores, NonZeroUsize::get)
    }
}

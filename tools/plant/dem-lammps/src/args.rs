//! The command line.

use clap::Parser;
use cli::{OutPath, Output, Source};
use std::num::NonZeroUsize;

const EXAMPLES: &str = "Examples:\n\
    \x20 dem-lammps spheres.toml -o lammps.mcap\n\
    \x20 dem-lammps spheres.toml --write-deck deck\n\
    \x20 (cd deck && lmp -in run.in)\n\
    \x20 dem-lammps spheres.toml --read-dump deck/frames.dump -o lammps.mcap";

/// Run a DEM scene on LAMMPS and write a run MCAP, as dem-run does
#[derive(Parser)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// The scene (TOML), - for stdin
    #[arg(value_name = "SCENE.toml")]
    pub scene: Source,
    /// Walls and inlets (MCAP), - for stdin; inlets are read to their end before LAMMPS starts
    #[arg(value_name = "WALLS|INLET.mcap")]
    pub inputs: Vec<Source>,
    /// Change a key of the scene, such as contact.0.restitution=0.3 (repeat for more)
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// End of the run [s], instead of time.until
    #[arg(long, value_name = "S")]
    pub until: Option<f64>,
    /// Where LAMMPS lacks something, use the nearest that it has, with a warning
    #[arg(long)]
    pub nearest: bool,
    /// Check the scene and its inputs without running LAMMPS
    #[arg(long)]
    pub check: bool,
    /// Write only the deck (input script, data file, batch script for Slurm) into a folder
    #[arg(long, value_name = "DIR")]
    pub write_deck: Option<OutPath>,
    /// Read the frames of a deck that has run elsewhere
    #[arg(long, value_name = "FILE")]
    pub read_dump: Option<Source>,
    /// Keep the deck, frames and LAMMPS' restart files in a folder; the same command continues there
    #[arg(long, value_name = "DIR")]
    pub dir: Option<OutPath>,
    /// MPI ranks [default: 1]
    #[arg(long, value_name = "N")]
    pub ranks: Option<NonZeroUsize>,
    /// The LAMMPS program with its options, such as "lmp -sf omp -pk omp 2" [default: lmp]
    #[arg(long, value_name = "PROGRAM")]
    pub lmp: Option<String>,
    /// The MPI launcher with its options, for more than one rank [default: mpirun]
    #[arg(long, value_name = "PROGRAM")]
    pub mpirun: Option<String>,
    /// Write one JSON line to stderr with each frame: time, steps, particles
    #[arg(long)]
    pub progress: bool,
    #[command(flatten)]
    pub output: Output,
}

impl Args {
    /// Refuses options that change nothing.
    ///
    /// # Errors
    /// Wrong usage.
    pub fn check(&self) -> anyhow::Result<()> {
        let inputs = [&self.scene].into_iter().chain(&self.inputs).chain(&self.read_dump);
        Source::one_stdin(inputs)?;
        let modes = [
            ("--check", self.check),
            ("--write-deck", self.write_deck.is_some()),
            ("--read-dump", self.read_dump.is_some()),
        ];
        let mut given = modes.into_iter().filter(|mode| mode.1).map(|mode| mode.0);
        let mode = given.next();
        if let (Some(first), Some(second)) = (mode, given.next()) {
            return Err(cli::usage(format!("{second}: {first} runs nothing: leave one of them out")));
        }
        let Some(mode) = mode else {
            return match (&self.mpirun, self.ranks.map_or(1, NonZeroUsize::get)) {
                (Some(_), 1) => {
                    Err(cli::usage("--mpirun: one rank needs no launcher: give --ranks, or leave it out"))
                }
                _ => Ok(()),
            };
        };
        let reads = mode == "--read-dump";
        let unused = [
            ("--ranks", self.ranks.is_some() && mode != "--write-deck"),
            ("--lmp", self.lmp.is_some() && reads),
            ("--mpirun", self.mpirun.is_some()),
            ("--progress", self.progress),
            ("--dir", self.dir.is_some()),
            ("-o", self.output.path().is_some() && !reads),
        ];
        match unused.into_iter().find(|option| option.1) {
            Some((option, _)) => Err(cli::usage(format!("{option}: {mode} runs nothing: leave it out"))),
            None => Ok(()),
        }
    }
}

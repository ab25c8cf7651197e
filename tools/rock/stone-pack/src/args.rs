//! The command line.

use crate::inputs::Grains;
use cli::OutPath;
use geom::{Shape, shape::Solid};
use scene::plan::implausible_density;
use std::path::PathBuf;
use stones::PackSettings;

const EXAMPLES: &str = "The output has the columns of the soil, and cluster (0: soil; else the number of the stone), class and material (that of the soil; the last one is that of \
    the stones). A scene reads it with [[particles]] source = \"specimen.ply\", materials = [\"soil\", \"rock\"].\n\nExamples:\n\
    \x20 stone-pack soil.mcap stones --content 0.3 --stone-density 2650 -o specimen.ply\n\
    \x20 stone-pack soil.mcap stones --content 0.3 --stone-density 2650 --grading grading.csv -o s.ply\n\
    \x20 stone-pack soil.mcap stones --content 0.6 --stone-density 2650 --crowd 300 -o s.ply";

/// Place stones of real shape, without overlap, in settled soil
#[derive(clap::Parser)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Settled soil: a run (its last frame), or PLY or CSV with x, y, z, radius
    #[arg(value_name = "SOIL.ply|RUN.mcap")]
    pub soil: PathBuf,
    /// Folder of closed meshes (PLY, STL, OBJ); names rock_N_H give size classes N
    #[arg(value_name = "LIBRARY-DIR")]
    pub library: PathBuf,
    #[command(flatten)]
    pub output: cli::Output,
    /// Mass of the stones over the total mass: 0.3, or 30%
    #[arg(long, value_name = "SHARE", value_parser = geom::number::share)]
    content: f64,
    /// Density of the stones [kg/m³]
    #[arg(long, value_name = "KG/M3", value_parser = geom::number::positive)]
    pub stone_density: f64,
    /// Density of the soil grains [kg/m³] [default: that of the run]
    #[arg(long, value_name = "KG/M3", value_parser = geom::number::positive)]
    pub soil_density: Option<f64>,
    /// Classes (CSV): from,to,share (sieve sizes in m; stones are scaled into them), or class,share (stones rock_N_H at their own size) [default: all stones at their own size]
    #[arg(long, value_name = "FILE")]
    pub grading: Option<PathBuf>,
    /// Allowed excess of the content and of each class, over it
    #[arg(long, value_name = "SHARE", value_parser = geom::number::share, default_value = "0.01")]
    tolerance: f64,
    /// Most tries for each class
    #[arg(long, value_name = "N", default_value = "10000", value_parser = clap::value_parser!(u64).range(1..=10_000))]
    tries: u64,
    /// When the tries of a class have run out, make room for its other stones: a stone begins small and grows, in at most so many rounds of small random moves of all near it
    #[arg(long, value_name = "ROUNDS", value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub crowd: Option<u64>,
    /// Fewest grains of a stone
    #[arg(long, value_name = "N", default_value = "2", value_parser = clap::value_parser!(u32).range(1..))]
    least_grains: u32,
    /// Box that stones lie in, box:x0,y0,z0,x1,y1,z1 [m] [default: that of the soil]
    #[arg(long, value_name = "SHAPE")]
    within: Option<Shape>,
    #[command(flatten)]
    pub lengths: cli::Lengths,
    #[command(flatten)]
    pub placing: cli::Placing,
    /// Write the lines of a scene that reads the grains: [[particles]], and the [[material]] of the stones with the density at which their grains weigh what the stones do (TOML)
    #[arg(long, value_name = "FILE.toml", conflicts_with = "rigid")]
    pub scene: Option<OutPath>,
    /// Name of the stones' material, for the report, for --scene and for --rigid [default: rock]
    #[arg(long, value_name = "NAME", value_parser = record::name::name)]
    material: Option<String>,
    /// Stones are clusters of grains that bonds hold together, and can break (default)
    #[arg(long, conflicts_with = "rigid")]
    bonded: bool,
    /// Stones are rigid clumps of their grains: -o has only the soil, and FILE.toml the [[clump]] and [[body]] of each stone
    #[arg(long = "rigid", id = "rigid", value_name = "FILE.toml")]
    pub bodies: Option<OutPath>,
    /// Write name, class, place, orientation, size and mass of each stone (CSV)
    #[arg(long, value_name = "FILE")]
    pub places: Option<OutPath>,
    /// Write the surfaces of the placed stones as one mesh (PLY)
    #[arg(long, value_name = "FILE")]
    pub surfaces: Option<OutPath>,
    #[command(flatten)]
    pub seed: cli::Seed,
    #[command(flatten)]
    common: cli::Common,
}

impl Args {
    /// Name of the stones' material.
    pub fn material(&self) -> &str {
        self.material.as_deref().unwrap_or("rock")
    }

    /// Refuses a name of another format, and an option that would change nothing.
    pub fn check_used(&self) -> anyhow::Result<()> {
        if self.material.is_some()
            && self.bodies.is_none()
            && self.scene.is_none()
            && self.common.report.is_none()
        {
            return Err(cli::usage(
                "--material: changes nothing without --scene, --rigid or --report: the PLY has numbers of materials: leave it out",
            ));
        }
        for (option, density) in
            [("--stone-density", Some(self.stone_density)), ("--soil-density", self.soil_density)]
        {
            if let Some((d, (why, cure))) = density.and_then(|d| Some((d, implausible_density(d)?))) {
                cli::warn(&format!("{option} {} kg/m³ {why}: {cure}", geom::Shown(d)));
            }
        }
        if let Some(path) = self.surfaces.as_ref().filter(|path| path.extension().is_none_or(|e| e != "ply"))
        {
            let path = path.display();
            return Err(cli::usage(format!(
                "--surfaces {path}: the mesh is PLY: use a name that ends in .ply"
            )));
        }
        let ending = self.output.path().and_then(std::path::Path::extension);
        if ending.is_none() || self.output.has_extension("ply") {
            return Ok(());
        }
        let name = self.output.name();
        Err(cli::usage(format!("-o {name}: the output is PLY: use a name that ends in .ply")))
    }

    /// What is asked for.
    pub fn settings(&self, grains: &Grains) -> anyhow::Result<PackSettings> {
        let bounds = match &self.within {
            None => grains.bounds(),
            Some(Shape { solid: Solid::Box(lo, hi), outside: false }) => [*lo, *hi],
            Some(_) => return Err(cli::usage("--within: give a box: box:x0,y0,z0,x1,y1,z1")),
        };
        if (bounds[1] - bounds[0]).min() <= 0.0 {
            return Err(cli::usage("--within: the box has no volume: give its lowest corner first"));
        }
        Ok(PackSettings {
            content: self.content,
            tolerance: self.tolerance,
            density: self.stone_density,
            bounds,
            tries: self.tries,
            rounds: self.crowd.unwrap_or(0),
            least_grains: self.least_grains as usize,
            seed: self.seed.seed(),
        })
    }
}

//! The command line.

use clap::{Parser, ValueEnum};
use cli::{Output, Source};
use geom::Plane;
use scene::{ZoneMotion, ZoneTest};
use stages::split::{Cut, Stage};
use std::path::Path;

const EXAMPLES: &str = "Examples:\n\
    \x20 stage-split plant.toml --at 0,0,0.02,0,0,-1 --keep upstream -o up.toml\n\
    \x20 stage-split plant.toml --at 0,0,0.02,0,0,-1 --keep downstream -o down.toml";

/// Cut a scene at a plane and write the scene of one stage
#[derive(Parser)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// The scene (TOML), - for stdin
    #[arg(value_name = "SCENE.toml", default_value = "-", hide_default_value = true)]
    pub scene: Source,
    /// The plane, px,py,pz,nx,ny,nz; the normal points in the direction of flow
    #[arg(long, value_name = "PLANE", allow_hyphen_values = true)]
    at: Plane,
    /// The stage to write
    #[arg(long, value_enum)]
    keep: Keep,
    /// Length of the zone behind the plane [m] (default: 1.2 times the largest diameter)
    #[arg(long, value_name = "M", value_parser = cli::length)]
    length: Option<f64>,
    /// Motion in the zone, the same in both stages
    #[arg(long, value_enum, default_value = "recorded")]
    motion: Motion,
    /// Which point of a particle triggers a crossing: its centre, or the foremost point of its surface along the plane's normal
    #[arg(long, value_enum, default_value = "centre")]
    test: Test,
    #[command(flatten)]
    pub output: Output,
}

#[derive(Clone, Copy, ValueEnum)]
enum Keep {
    Upstream,
    Downstream,
}

#[derive(Clone, Copy, ValueEnum)]
enum Motion {
    /// Upstream as ever, until they are removed at the end of the zone; downstream along the paths that they took upstream
    Recorded,
    /// In free fall
    Ballistic,
    /// At the constant velocity that the grain had at the plane
    Constant,
}

#[derive(Clone, Copy, ValueEnum)]
enum Test {
    Centre,
    Lowest,
}

impl Args {
    /// The requested cut.
    pub fn cut(&self) -> Cut {
        Cut {
            plane: self.at,
            keep: match self.keep {
                Keep::Upstream => Stage::Upstream,
                Keep::Downstream => Stage::Downstream,
            },
            length: self.length,
            motion: match self.motion {
                Motion::Constant => ZoneMotion::Constant,
                Motion::Ballistic => ZoneMotion::Ballistic,
                Motion::Recorded => ZoneMotion::Recorded,
            },
            test: match self.test {
                Test::Centre => ZoneTest::Centre,
                Test::Lowest => ZoneTest::Lowest,
            },
            folder: self.output.path().and_then(Path::parent).unwrap_or(Path::new("")).to_owned(),
        }
    }
}

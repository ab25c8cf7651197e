//! The command line.

use clap::{Parser, ValueEnum};
use cli::{Output, Source, usage};
use geom::number::finite;
use geom::{Plane, Vec3};
use scene::ZoneMotion;
use stages::replay::{Copies, Frame, Intervals, Passage, Replay};

const EXAMPLES: &str = "Examples:\n\
    \x20 dem-run up.toml | tee up.mcap | stage-replay | dem-run down.toml - -o down.mcap\n\
    \x20 stage-replay up.mcap --until 0.04 -o inlet.mcap";

/// Turn the crossings of a run into an inlet MCAP, also while the run is still being written
#[derive(Parser)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// The run (MCAP), - for stdin; give all files of a run that was stopped and resumed, in the order of their times
    #[arg(value_name = "RUN.mcap", default_value = "-", hide_default_value = true)]
    pub runs: Vec<Source>,
    /// Calculation plane, px,py,pz,nx,ny,nz (default: the storage plane of the run)
    #[arg(long, value_name = "PLANE", allow_hyphen_values = true)]
    at: Option<Plane>,
    /// Length of the zone before the calculation plane [m] (default: that of the run)
    #[arg(long, value_name = "M", value_parser = cli::length)]
    length: Option<f64>,
    /// Leave out crossings before S; S becomes time 0 [s]
    #[arg(long, value_name = "S", value_parser = cli::seconds)]
    from: Option<f64>,
    /// Leave out crossings at S or later [s]
    #[arg(long, value_name = "S", value_parser = cli::seconds)]
    until: Option<f64>,
    /// Keep the recorded arrival times (default: the first grain enters at time 0)
    #[arg(long, conflicts_with = "from")]
    keep_times: bool,
    /// Index of the storage plane
    #[arg(long, value_name = "N", default_value_t = 0)]
    outlet: u16,
    /// Where grains keep their recorded intervals: on the generation plane, or on both planes of the zone, which avoids overlaps in a dense flow
    #[arg(long, value_enum, default_value = "both")]
    intervals: Keep,
    /// How passages are counted: as the instant within a step, or in whole time steps of the run
    #[arg(long, value_enum, default_value = "time")]
    passage: Count,
    /// Motion in the zone (default: that of the run)
    #[arg(long = "move", value_enum)]
    motion: Option<Motion>,
    /// With --intervals both: time from start to arrival of each grain [s] (default: the time that the first grain needs for the zone)
    #[arg(long, value_name = "S", value_parser = cli::span)]
    ahead: Option<f64>,
    /// Rotate the record by this angle about --axis: positions, velocities, spins, and the plane unless --at is given
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, value_parser = number)]
    turn_deg: Option<f64>,
    /// Axis of --turn-deg: a point [m] and a direction (default: 0,0,0,0,0,1)
    #[arg(long, value_name = "PX,PY,PZ,AX,AY,AZ", allow_hyphen_values = true, requires = "turn_deg")]
    axis: Option<Plane>,
    /// Shift the record, after the rotation [m]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = vector)]
    shift: Option<Vec3>,
    /// Replay the record N times, one after the other; the record is held in memory
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    repeat: u32,
    /// Time between the starts of two replays [s] (default: from the first crossing to the end of the run, also where nothing crosses any more)
    #[arg(long, value_name = "S", value_parser = cli::span, requires = "repeat")]
    period: Option<f64>,
    /// Superpose N copies of each grain; this scales the rate, and the file says so; needs --copy-shift or --copy-delay
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    copies: u32,
    /// Shift copy k by k times this vector [m]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = vector, requires = "copies")]
    copy_shift: Option<Vec3>,
    /// Delay copy k by k times this time [s]
    #[arg(long, value_name = "S", value_parser = cli::span, requires = "copies")]
    copy_delay: Option<f64>,
    /// Give grains new ids from N, in order of entry (default: from 0, only if several grains have the same id)
    #[arg(long, value_name = "N")]
    first_id: Option<u32>,
    #[command(flatten)]
    pub output: Output,
}

#[derive(Clone, Copy, ValueEnum)]
enum Keep {
    Generation,
    Both,
}

#[derive(Clone, Copy, ValueEnum)]
enum Count {
    Time,
    Steps,
}

#[derive(Clone, Copy, ValueEnum)]
enum Motion {
    /// At the constant velocity that the grain had at the plane
    Constant,
    /// In free fall
    Ballistic,
    /// Along the paths that the grains took in the upstream stage
    Recorded,
}

impl Args {
    /// What the options ask for.
    ///
    /// # Errors
    /// Options that do not go together.
    pub fn what(&self) -> anyhow::Result<Replay> {
        if let (Some(from), Some(until)) = (self.from, self.until)
            && until <= from
        {
            return Err(usage(format!("--until {until} s is not after --from {from} s: give a later end")));
        }
        if self.copies > 1 && self.copy_shift.is_none() && self.copy_delay.is_none() {
            let why = "the copies would overlap: give --copy-shift X,Y,Z or --copy-delay S";
            return Err(usage(format!("--copies {}: {why}", self.copies)));
        }
        for (option, given) in
            [("--copy-shift", self.copy_shift.is_some()), ("--copy-delay", self.copy_delay.is_some())]
        {
            if self.copies == 1 && given {
                return Err(usage(format!(
                    "{option}: one copy is the record itself: give --copies 2 or more"
                )));
            }
        }
        if self.repeat == 1 && self.period.is_some() {
            return Err(usage("--period: the record is replayed once: give --repeat 2 or more"));
        }
        if let (Some(ahead), Keep::Generation) = (self.ahead, self.intervals) {
            let why =
                "changes nothing with --intervals generation, where every grain starts when it was recorded";
            return Err(usage(format!("--ahead {ahead}: {why}: leave one of them out")));
        }
        let upright = Plane { point: Vec3::zeros(), normal: Vec3::z() };
        let axis = self.axis.unwrap_or(upright);
        let turned = self.turn_deg.is_some() || self.shift.is_some();
        let (angle, shift) = (self.turn_deg.unwrap_or(0.0).to_radians(), self.shift.unwrap_or_default());
        Ok(Replay {
            at: self.at,
            length: self.length,
            from: self.from,
            until: self.until,
            keep_times: self.keep_times,
            outlet: self.outlet,
            intervals: match self.intervals {
                Keep::Generation => Intervals::Generation,
                Keep::Both => Intervals::Both,
            },
            passage: match self.passage {
                Count::Time => Passage::Time,
                Count::Steps => Passage::Steps,
            },
            motion: self.motion.map(|motion| match motion {
                Motion::Constant => ZoneMotion::Constant,
                Motion::Ballistic => ZoneMotion::Ballistic,
                Motion::Recorded => ZoneMotion::Recorded,
            }),
            ahead: self.ahead,
            frame: turned.then(|| Frame::new(&axis, angle, shift)),
            copies: Copies {
                count: self.copies,
                shift: self.copy_shift.unwrap_or_default(),
                delay: self.copy_delay.unwrap_or(0.0),
            },
            repeat: self.repeat,
            period: self.period,
            first_id: self.first_id,
        })
    }
}

fn number(text: &str) -> Result<f64, String> {
    finite(text).map_err(|_| "give a number, such as 90".into())
}

fn vector(text: &str) -> Result<Vec3, String> {
    let numbers: Result<Vec<f64>, String> = text.split(',').map(number).collect();
    let three = numbers.ok().and_then(|n| <[f64; 3]>::try_from(n).ok());
    three.map(Vec3::from).ok_or_else(|| "give three lengths in metres, such as 0.1,0,0".into())
}

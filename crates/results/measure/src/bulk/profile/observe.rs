//! Profiles of chosen frames of a run.

use super::{Grid, Turn};
use crate::definition::{AskError, Asked, Bins, Figure, Frames, Measure, column};
use crate::observer::{Observer, OfFrame, PerFrame};
use crate::periodic::PeriodicBox;
use crate::reading::table;
use crate::selection::Which;
use crate::sheet::{Chart, Head, Panel, Row, Summary};
use crate::{Frame, MeasureError, Run, RunMessage};
use geom::Vec3;
use geom::shape::Solid;
use std::borrow::Cow;

/// What the options ask for.
#[derive(Debug, Clone, PartialEq)]
pub struct ProfileOptions {
    /// Number of cells along x, y, z.
    pub bins: [usize; 3],
    /// Corners of the grid along its axes [m]; `None`: the box around all grains of the first frame. [`BoxOfFrames`] finds that of all frames.
    pub corners: Option<(Vec3, Vec3)>,
    /// Axes of the grid; `None`: those of the scene.
    pub turn: Option<Turn>,
    /// Whether frames are averaged.
    pub mean: bool,
    /// Other columns of `/particles` whose mass-weighted mean is wanted.
    pub fields: Vec<String>,
}

/// The box around all grains of the frames between two times, along the axes of a grid.
pub struct BoxOfFrames {
    which: Which,
    turn: Option<Turn>,
    corners: Option<(Vec3, Vec3)>,
}

impl BoxOfFrames {
    /// Nothing seen yet.
    pub fn new(which: Which, turn: Option<Turn>) -> BoxOfFrames {
        BoxOfFrames { which, turn, corners: None }
    }

    /// Takes what a run has told.
    pub fn take(&mut self, run: &Run, message: &RunMessage) {
        let RunMessage::Frame(frame) = message else { return };
        let chosen =
            matches!(self.which, Which::Between(from, until) if run.is_between((from, until), frame.time));
        if frame.is_empty() || !chosen {
            return;
        }
        let bounds = self.turn.map_or_else(|| in_box(frame), |turn| seen_along(frame, turn).bounds());
        self.corners = Some(self.corners.map_or(bounds, |b| (b.0.inf(&bounds.0), b.1.sup(&bounds.1))));
    }

    /// Its corners [m]; `None`: no grain.
    pub fn corners(&self) -> Option<(Vec3, Vec3)> {
        self.corners
    }
}

/// Measures profiles of chosen frames.
pub struct Profile {
    options: ProfileOptions,
    grid: Option<Grid>,
    bounds: Option<(Vec3, Vec3)>,
    fraction: f64,
    /// Grains so far, and those of them whose centres are outside a grid around the first frame.
    grains: [u64; 2],
}

impl Profile {
    /// With these options.
    ///
    /// # Errors
    /// No cells, too many cells, no room between the corners.
    pub fn new(options: ProfileOptions) -> Result<Profile, MeasureError> {
        let (low, high) = options.corners.unwrap_or((Vec3::zeros(), Vec3::repeat(1.0)));
        Grid::new(low, high, options.bins, 0)?;
        Ok(Profile { options, grid: None, bounds: None, fraction: f64::NAN, grains: [0; 2] })
    }

    fn fields(&self, frame: &Frame) -> Result<Vec<Vec<f64>>, MeasureError> {
        let of = |name: &String| {
            let has = || table::names(&frame.table);
            let values = frame.table.get(name).map(|v| v.to_f64());
            values.ok_or_else(|| MeasureError::Field { name: name.clone(), has: has() })
        };
        self.options.fields.iter().map(of).collect()
    }
}

/// The box around all grains; along an axis that one reaches through a periodic face of, the whole period: its image is at the other.
fn in_box(frame: &Frame) -> (Vec3, Vec3) {
    let ((mut low, mut high), room) = (frame.bounds(), frame.periodic.corners());
    for axis in (0..3).filter(|&k| low[k] < room.0[k] || high[k] > room.1[k]).collect::<Vec<usize>>() {
        (low[axis], high[axis]) = (room.0[axis], room.1[axis]);
    }
    (low, high)
}

/// A frame with positions and velocities along turned axes.
fn seen_along(frame: &Frame, turn: Turn) -> Frame {
    let along = |all: &[Vec3]| all.iter().map(|v| turn.components(v)).collect();
    Frame { position: along(&frame.position), velocity: along(&frame.velocity), ..frame.clone() }
}

impl OfFrame for Profile {
    fn heads(&self) -> Vec<Head> {
        let mut heads = Head::list(&[
            ("time", "s"),
            ("x", "m"),
            ("y", "m"),
            ("z", "m"),
            ("solid_fraction", "1"),
            ("grains", "1"),
            ("vx", "m/s"),
            ("vy", "m/s"),
            ("vz", "m/s"),
            ("speed", "m/s"),
            ("granular_temperature", "m²/s²"),
            ("d10", "m"),
            ("d32", "m"),
        ]);
        heads.extend(self.options.fields.iter().map(|f| Head { name: f.clone(), unit: "as in the run" }));
        heads
    }

    fn measure(&mut self, _: &Run, frame: &Frame) -> Result<Vec<Row>, MeasureError> {
        // Turned, the axes of the grid are not those of the box: what of a ball is beyond a face stays there.
        let (seen, room, bounds) = match self.options.turn {
            Some(turn) => {
                let turned = seen_along(frame, turn);
                let bounds = turned.bounds();
                (Cow::Owned(turned), PeriodicBox::default().corners(), bounds)
            }
            None => (frame.with_images(), frame.periodic.corners(), in_box(frame)),
        };
        let fields = self.fields(&seen)?;
        if frame.is_empty() && self.options.corners.is_none() && self.grid.is_none() {
            return Ok(Vec::new());
        }
        self.bounds = Some(self.bounds.map_or(bounds, |b| (b.0.inf(&bounds.0), b.1.sup(&bounds.1))));
        let (low, high) = self.options.corners.or(self.grid.as_ref().map(Grid::corners)).unwrap_or(bounds);
        let kept = if self.options.mean { self.grid.take() } else { None };
        let mut grid = match kept {
            Some(grid) => grid,
            None => Grid::new(low, high, self.options.bins, fields.len())?,
        };
        grid.add(&seen, &room, &fields)?;
        if self.options.corners.is_none() {
            let outside = |p: &&Vec3| (0..3).any(|k| p[k] < low[k] || p[k] > high[k]);
            self.grains[0] += frame.len() as u64;
            // Images come behind the grains.
            self.grains[1] += seen.position.iter().take(frame.len()).filter(outside).count() as u64;
        }
        self.fraction = grid.solid_fraction();
        let rows = if self.options.mean { Vec::new() } else { grid.rows() };
        self.grid = Some(grid);
        Ok(rows)
    }

    fn end(&mut self) -> Result<(Vec<Row>, Summary), MeasureError> {
        let Some(grid) = &self.grid else {
            return Err(MeasureError::FewGrains { what: "a profile", most: 0, wanted: 1 });
        };
        if self.fraction == 0.0 {
            let (low, high) = self.bounds.unwrap_or_default();
            return Err(MeasureError::NothingInside { what: "grain", low: low.into(), high: high.into() });
        }
        let rows = if self.options.mean { grid.rows() } else { Vec::new() };
        let (low, high) = grid.corners();
        let summary = Summary::default()
            .with("solid_fraction", "1", self.fraction)
            .with("frames", "1", if self.options.mean { grid.frames as f64 } else { 1.0 })
            .with("cell", "m³", grid.cell());
        let in_words = |(low, high): (Vec3, Vec3)| {
            let corners = low.iter().chain(high.iter()).map(|v| geom::Shown(*v).to_string());
            format!("box:{}", corners.collect::<Vec<_>>().join(","))
        };
        let turned = self.options.turn.map_or(String::new(), |turn| {
            let axis = ["x", "y", "z"][turn.axis];
            format!(", in axes turned by {}° about {axis}", geom::Shown(turn.degrees))
        });
        let summary = summary.note(format!("grid in {}{turned}", in_words((low, high))));
        let [all, outside] = self.grains;
        let all_grains = self.bounds.filter(|_| outside > 0).map(in_words);
        let missed = all_grains.map(|around| {
            let percent = 100.0 * outside as f64 / all as f64;
            format!(
                "{percent:.1} % of the grains are outside this grid, which is around those of the first frame: give --within \
                 {around}, or read the run from a file"
            )
        });
        Ok((rows, missed.into_iter().fold(summary, Summary::note)))
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        let bins = self.options.bins;
        let last = rows.len().saturating_sub(bins.iter().product());
        let rows = &rows[last..];
        let wide: Vec<usize> = (0..3).filter(|k| bins[*k] > 1).collect();
        let turned = if self.options.turn.is_some() { "′" } else { "" };
        let name = |axis: usize| format!("{}{turned} [m]", ["x", "y", "z"][axis]);
        let time = rows.first().map_or(0.0, |r| r[0]);
        let title = if self.options.mean { "Mean profile until" } else { "Profile at" };
        let mut chart = Chart::new(format!("{title} {time:.4} s"));
        match wide[..] {
            [] | [_] => {
                let axis = wide.first().copied().unwrap_or(2);
                let (label, x) = (name(axis), axis + 1);
                chart = chart
                    .columns((&label, x), "solid fraction [1]", &[("", 4)], rows)
                    .columns((&label, x), "velocity [m/s]", &[("vx", 6), ("vy", 7), ("vz", 8)], rows)
                    .columns((&label, x), "size [m]", &[("d10", 11), ("d32", 12)], rows);
            }
            [a, b, ..] => {
                let (Some(first), Some(end)) = (rows.first(), rows.last()) else { return chart };
                let half = self.grid.as_ref().map_or(Vec3::zeros(), |g| g.step * 0.5);
                let range = [
                    first[a + 1] - half[a],
                    first[b + 1] - half[b],
                    end[a + 1] + half[a],
                    end[b + 1] + half[b],
                ];
                for (value, column) in [("solid fraction [1]", 4), ("speed [m/s]", 9)] {
                    // Of a grid with three wide axes, the layer in the middle of the last one.
                    let layer = if wide.len() == 3 { bins[2] / 2 * bins[0] * bins[1] } else { 0 };
                    let cell = |i: usize, j: usize| rows[layer + j * bins[a] + i][column];
                    let cells = (0..bins[b]).map(|j| (0..bins[a]).map(|i| cell(i, j)).collect()).collect();
                    let (x, y, value) = (name(a), name(b), value.to_owned());
                    chart.panels.push(Panel::Map { x, y, value, range, cells });
                }
            }
        }
        chart
    }
}

impl Measure for Profile {
    const NAME: &'static str = "profile";
    const HELP: &'static str = "Velocity, solid fraction and size on a grid";
    const FRAMES: Frames = Frames::Last;
    const OPTIONS: &'static [&'static str] = &["within", "axis", "bins", "turn-deg", "mean", "field"];
    const FIGURES: &'static [Figure] = &[column("velocity-profile", "speed")];

    fn observer(asked: &Asked) -> Result<Box<dyn Observer>, AskError> {
        let mut options = grid(asked)?;
        if options.corners.is_none() && matches!(asked.which, Which::Between(..)) {
            options.corners = (asked.box_of)(asked.which, options.turn).map_err(AskError::Look)?;
        }
        Ok(Box::new(PerFrame::new(Profile::new(options)?)))
    }
}

/// The grid that was asked for.
fn grid(asked: &Asked) -> Result<ProfileOptions, AskError> {
    let corners = match asked.within.as_ref().map(|given| (&given.shape, &given.text)) {
        None => None,
        Some((shape, text)) => match &shape.solid {
            Solid::Box(low, high) if !shape.outside => Some((*low, *high)),
            _ => {
                let why = format!("--within {text}: the grid of --profile is a box: give box:…");
                return Err(AskError::Usage(why));
            }
        },
    };
    let mut bins = [1; 3];
    match asked.bins.unwrap_or(Bins::One(20)) {
        Bins::One(n) => bins[asked.axis.unwrap_or(2)] = n,
        Bins::All(_) if asked.axis.is_some() => {
            return Err(AskError::Usage("--axis: --bins gives all three axes: leave --axis out".to_owned()));
        }
        Bins::All(all) => bins = all,
    }
    Ok(ProfileOptions { bins, corners, turn: asked.turn, mean: asked.mean, fields: asked.fields.clone() })
}

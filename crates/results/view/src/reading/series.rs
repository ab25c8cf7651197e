//! All moments of everything, for a film or a series of files; the caller chooses what is kept of each state.

use crate::reading::show::{LayerHead, Show, add_surface};
use crate::{DrawnTable, PartValues, Role, ViewError, WallSurface, WearState};
use record::WallsEnd;
use std::borrow::Cow;
use stream::Table;

/// The part of a run that is shown.
#[derive(Debug, Clone, Copy)]
pub struct Span {
    /// First time [s].
    pub from: f64,
    /// Last time [s].
    pub to: f64,
    /// Least time between two states [s].
    pub every: Option<f64>,
}

/// One thing, over time.
pub struct SeriesLayer<T> {
    pub head: LayerHead,
    /// Of a layer that moves: its state at t = 0.
    pub home: Option<Table>,
    /// What is kept of each state, with its time [s].
    pub states: Vec<(f64, T)>,
    /// Number of the step of the span that was last taken.
    taken: Option<i64>,
    /// Time of the state before [s].
    before: Option<f64>,
}

/// Keeps of a state (number of the layer, layer, time, columns) what is needed later.
pub type KeepState<T> = Box<dyn FnMut(usize, &SeriesLayer<T>, f64, Table) -> Result<T, ViewError>>;

/// Share of the time between two frames by which they may miss their time [–]: a frame is written at the end of the
/// step in which its time comes.
const MISS: f64 = 0.05;

/// What is kept of all layers.
pub struct Series<T> {
    /// Layers, in the order in which they were added.
    pub layers: Vec<SeriesLayer<T>>,
    /// Planes and meshes.
    pub surfaces: Vec<WallSurface>,
    /// Where walls end, where the run tells it.
    pub walls_end: Option<WallsEnd>,
    /// What walls are coloured by, from times on [s].
    wear: Vec<(f64, WearState)>,
    span: Span,
    keep: KeepState<T>,
}

impl<T> Series<T> {
    /// Keeps what `keep` makes of each state in the span.
    pub fn new(span: Span, keep: KeepState<T>) -> Series<T> {
        Series { layers: Vec::new(), surfaces: Vec::new(), walls_end: None, wear: Vec::new(), span, keep }
    }

    /// The times that grains were kept of, in order; without grains, those of all else.
    pub fn times(&self) -> Vec<f64> {
        let of = |grains: bool| {
            let layers = self.layers.iter().filter(|l| (l.head.role == Role::Grains) == grains);
            let times = layers.flat_map(|l| l.states.iter().map(|(time, _)| *time));
            let mut times: Vec<f64> = times.filter(|t| grains || self.span.holds(*t, 0.0)).collect();
            times.sort_by(f64::total_cmp);
            let spacing = times.last().zip(times.first()).map_or(0.0, |(b, a)| (b - a) / times.len() as f64);
            // Frames of two runs that are meant to be of one time are one picture.
            times.dedup_by(|b, a| *b - *a <= 2.0 * MISS * spacing);
            times
        };
        let grains = of(true);
        if grains.is_empty() { of(false) } else { grains }
    }
}

impl<T> SeriesLayer<T> {
    /// The state nearest to `time` [s].
    pub fn at(&self, time: f64) -> Option<&T> {
        let far = |state: &&(f64, T)| (state.0 - time).abs();
        let nearest = self.states.iter().min_by(|a, b| far(a).total_cmp(&far(b)));
        nearest.map(|(_, state)| state)
    }
}

impl Series<Table> {
    /// Each layer at a time [s], in its order; `None` where it has no state.
    ///
    /// # Errors
    /// Values of walls that do not fit their spheres.
    pub fn tables(&self, time: f64) -> Result<Vec<Option<Cow<'_, Table>>>, ViewError> {
        let wear = self.wear_at(time);
        let mut all = Vec::new();
        for (number, layer) in self.layers.iter().enumerate() {
            let mut table = match &layer.home {
                Some(home) => Some(Cow::Owned(record::moved(home, &layer.head.motion.pose(time)))),
                None => layer.at(time).map(Cow::Borrowed),
            };
            if let (Some(wear), Some(table)) = (wear, &mut table)
                && wear.of_layer(number).is_some()
            {
                wear.fill(number, table.to_mut())?;
            }
            all.push(table);
        }
        Ok(all)
    }

    /// What walls are coloured by at a time [s].
    fn wear_at(&self, time: f64) -> Option<&WearState> {
        // A hair: messages have their times in nanoseconds.
        let last = self.wear.iter().rev().find(|(from, _)| *from <= time + 1e-9);
        last.or(self.wear.first()).map(|(_, state)| state)
    }

    /// What the faces of each surface are coloured by at a time [s].
    pub fn surface_values(&self, time: f64) -> Vec<Option<PartValues>> {
        self.wear_at(time).map(|wear| wear.of_surfaces(self.surfaces.len())).unwrap_or_default()
    }

    /// What to draw of these tables.
    pub fn parts<'a>(&self, tables: &'a [Option<Cow<'a, Table>>]) -> Vec<DrawnTable<'a>> {
        let shown = self.layers.iter().zip(tables);
        shown.filter_map(|(layer, table)| Some(layer.head.part(table.as_deref()?))).collect()
    }
}

impl Span {
    /// Whether a time that may be missed by `slack` [s] is in it.
    fn holds(&self, time: f64, slack: f64) -> bool {
        // And a hair: 0.3 s is stored in nanoseconds.
        (self.from - slack - 1e-9..=self.to + slack + 1e-9).contains(&time)
    }

    /// The number of the step that holds a time; none outside.
    fn step(&self, time: f64, slack: f64) -> Option<i64> {
        let start = if self.from.is_finite() { self.from } else { 0.0 };
        let step = |every: f64| ((time - start + slack) / every + 1e-6).floor() as i64;
        self.holds(time, slack).then(|| self.every.map_or(0, step))
    }
}

impl<T> Show for Series<T> {
    fn layer(&mut self, head: LayerHead) -> usize {
        self.layers.push(SeriesLayer { head, home: None, states: Vec::new(), taken: None, before: None });
        self.layers.len() - 1
    }

    fn surface(&mut self, surface: WallSurface) -> usize {
        add_surface(&mut self.surfaces, surface)
    }

    fn walls_end(&mut self, end: WallsEnd) {
        self.walls_end = Some(end);
    }

    fn wear(&mut self, time: f64, state: WearState) -> Result<(), ViewError> {
        if time <= self.span.from {
            self.wear.clear();
        }
        if time <= self.span.to + 1e-9 || self.wear.is_empty() {
            self.wear.push((time, state));
        }
        Ok(())
    }

    fn push(&mut self, layer: usize, time: f64, table: Table) -> Result<(), ViewError> {
        let known = &mut self.layers[layer];
        if known.head.motion.moves() {
            known.home = Some(table);
            return Ok(());
        }
        // Walls and clouds are there from the first moment on, whichever that is.
        if known.head.role.moves() {
            let slack = known.before.map_or(0.0, |before| MISS * (time - before).max(0.0));
            known.before = Some(time);
            let Some(step) = self.span.step(time, slack) else { return Ok(()) };
            if self.span.every.is_some() && known.taken.is_some_and(|last| step <= last) {
                return Ok(());
            }
            known.taken = Some(step);
        } else if time > self.span.to + 1e-9 && !known.states.is_empty() {
            return Ok(());
        }
        let kept = (self.keep)(layer, &self.layers[layer], time, table)?;
        self.layers[layer].states.push((time, kept));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kept(span: Span) -> Vec<f64> {
        let mut series: Series<usize> = Series::new(span, Box::new(|_, _, _, table| Ok(table.rows())));
        let grains = series.layer(LayerHead::new(Role::Grains, "grains"));
        let walls = series.layer(LayerHead::new(Role::Walls, "walls"));
        series.push(walls, 0.0, Table::with_rows(7)).expect("kept");
        for k in 0..=10 {
            // Late by up to a step, as frames are.
            let time = f64::from(k) * 0.1 + 0.001 * f64::from(k % 3);
            series.push(grains, time, Table::with_rows(k as usize)).expect("kept");
        }
        assert_eq!(series.layers[walls].at(0.5), Some(&7));
        series.times()
    }

    #[test]
    fn a_span_takes_its_part_and_of_that_what_is_far_enough_apart() {
        let all = Span { from: f64::NEG_INFINITY, to: f64::INFINITY, every: None };
        assert_eq!(kept(all).len(), 11);
        let part = kept(Span { from: 0.2, to: 0.8, every: Some(0.2) });
        let near = |(a, b): (&f64, f64)| (a - b).abs() < 0.003;
        assert!(part.len() == 4 && part.iter().zip([0.2, 0.4, 0.6, 0.8]).all(near), "{part:?}");
    }
}

//! One moment of everything, for a picture.

use crate::reading::show::{LayerHead, Show, add_surface};
use crate::{DrawnTable, GrainCount, PartValues, Role, ViewError, WallSurface, WearState};
use record::WallsEnd;
use stream::Table;

/// One thing at the moment shown.
struct MomentLayer {
    head: LayerHead,
    /// The state that is shown, and its time [s].
    shown: Option<(f64, Table)>,
}

/// The state of each layer that is nearest to a time: a frame is written at the end of the step in which its time
/// comes, so the one meant is a little late.
pub struct Moment {
    until: f64,
    layers: Vec<MomentLayer>,
    surfaces: Vec<WallSurface>,
    /// Where walls end, where the run tells it.
    pub walls_end: Option<WallsEnd>,
    /// What walls are coloured by at the time shown, and what is later so far, with their times [s].
    wear: Option<(f64, WearState)>,
    later: Option<(f64, WearState)>,
}

/// A hair of time [s]: messages have theirs in nanoseconds.
const HAIR: f64 = 1e-9;

impl Moment {
    /// At `time` [s], or at the end.
    pub fn at(time: Option<f64>) -> Moment {
        Moment {
            until: time.unwrap_or(f64::INFINITY),
            layers: Vec::new(),
            surfaces: Vec::new(),
            walls_end: None,
            wear: None,
            later: None,
        }
    }

    /// The time of the grains shown [s]; of walls that are coloured, where there are none.
    pub fn time(&self) -> Option<f64> {
        self.time_of_grains().or_else(|| self.wear.as_ref().map(|(time, _)| *time))
    }

    fn time_of_grains(&self) -> Option<f64> {
        let grains = self.layers.iter().filter(|l| l.head.role == Role::Grains);
        grains.filter_map(|l| l.shown.as_ref()).map(|(time, _)| *time).reduce(f64::max)
    }

    /// The grains shown.
    pub fn grains(&self) -> GrainCount {
        let grains = self.layers.iter().filter(|l| l.head.role == Role::Grains);
        let shown = grains.filter_map(|l| l.shown.as_ref()).map(|(_, table)| GrainCount::of(table));
        shown.fold(GrainCount::default(), GrainCount::plus)
    }

    /// Moves walls to their positions at the time shown.
    ///
    /// # Errors
    /// Values of walls that do not fit their spheres.
    pub fn settle(&mut self) -> Result<(), ViewError> {
        self.choose_wear();
        if self.time_of_grains().is_none() {
            self.wear = self.later.take().or(self.wear.take());
        }
        let time = self.time().unwrap_or(0.0);
        for layer in self.layers.iter_mut().filter(|l| l.head.motion.moves()) {
            let pose = layer.head.motion.pose(time);
            layer.shown = layer.shown.take().map(|(_, home)| (time, record::moved(&home, &pose)));
        }
        let Some((_, wear)) = &self.wear else { return Ok(()) };
        for (number, layer) in self.layers.iter_mut().enumerate() {
            if let Some((_, table)) = &mut layer.shown {
                wear.fill(number, table)?;
            }
        }
        Ok(())
    }

    /// What came later is what is shown once the grains shown are as late.
    fn choose_wear(&mut self) {
        let time = self.time_of_grains();
        let reached = |(later, _): &mut (f64, WearState)| time.is_some_and(|time| *later <= time + HAIR);
        if let Some(reached) = self.later.take_if(reached) {
            self.wear = Some(reached);
        }
    }

    /// What the faces of each surface are coloured by.
    pub fn surface_values(&self) -> Vec<Option<PartValues>> {
        self.wear.as_ref().map(|(_, wear)| wear.of_surfaces(self.surfaces.len())).unwrap_or_default()
    }

    /// Planes and meshes.
    pub fn surfaces(&self) -> &[WallSurface] {
        &self.surfaces
    }

    pub fn parts(&self) -> Vec<DrawnTable<'_>> {
        let shown = self.layers.iter().filter_map(|l| l.shown.as_ref().map(|(_, table)| (l, table)));
        shown.map(|(layer, table)| layer.head.part(table)).collect()
    }
}

impl Show for Moment {
    fn layer(&mut self, head: LayerHead) -> usize {
        self.layers.push(MomentLayer { head, shown: None });
        self.layers.len() - 1
    }

    fn surface(&mut self, surface: WallSurface) -> usize {
        add_surface(&mut self.surfaces, surface)
    }

    fn walls_end(&mut self, end: WallsEnd) {
        self.walls_end = Some(end);
    }

    fn wear(&mut self, time: f64, state: WearState) -> Result<(), ViewError> {
        self.choose_wear();
        // Without grains, the state nearest to what is asked for.
        let far = |time: f64| (time - self.until).abs();
        let past = |(later, _): &(f64, WearState)| self.until.is_finite() && far(*later) <= far(time);
        if self.time_of_grains().is_some() || !self.later.as_ref().is_some_and(past) {
            self.later = Some((time, state));
        }
        Ok(())
    }

    fn push(&mut self, layer: usize, time: f64, table: Table) -> Result<(), ViewError> {
        let last = self.until.is_infinite();
        // Rods are those of the grains shown.
        if last && self.layers[layer].head.role.is_rods() && self.time() != Some(time) {
            return Ok(());
        }
        let shown = &self.layers[layer].shown;
        // Without a time asked for, the last frame that is not empty: at the end all grains may have left.
        if last && table.rows() == 0 && shown.is_some() && !self.layers[layer].head.role.is_rods() {
            return Ok(());
        }
        let shown = &mut self.layers[layer].shown;
        let far = |time: f64| (time - self.until).abs();
        let nearer = |(before, _): &(f64, Table)| last || far(time) < far(*before);
        if shown.as_ref().is_none_or(nearer) {
            *shown = Some((time, table));
            self.choose_wear();
        }
        Ok(())
    }
}

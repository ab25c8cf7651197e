//! One moment of everything, for a picture.

use crate::reading::show::{LayerHead, Show, add_surface};
use crate::{DrawnTable, GrainCount, Role, ViewError, WallSurface};
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
}

impl Moment {
    /// At `time` [s], or at the end.
    pub fn at(time: Option<f64>) -> Moment {
        Moment { until: time.unwrap_or(f64::INFINITY), layers: Vec::new(), surfaces: Vec::new() }
    }

    /// The time of the grains shown [s].
    pub fn time(&self) -> Option<f64> {
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
    pub fn settle(&mut self) {
        let time = self.time().unwrap_or(0.0);
        for layer in self.layers.iter_mut().filter(|l| l.head.motion.moves()) {
            let pose = layer.head.motion.pose(time);
            layer.shown = layer.shown.take().map(|(_, home)| (time, record::moved(&home, &pose)));
        }
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

    fn surface(&mut self, surface: WallSurface) {
        add_surface(&mut self.surfaces, surface);
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
        }
        Ok(())
    }
}

//! One moment of everything, for a picture.

use crate::inputs::Show;
use stream::Table;
use view::{Motion, Part, Role, Surface, ViewError};

/// One thing, as it is at the moment.
struct Layer {
    role: Role,
    name: String,
    kinds: Vec<String>,
    shown: Option<(f64, Table)>,
    motion: Motion,
}

/// The state of each layer that is nearest to a time: a frame is written at the end of the step in which its time
/// comes, so the one meant is a little late.
pub struct Moment {
    until: f64,
    layers: Vec<Layer>,
    surfaces: Vec<Surface>,
}

impl Moment {
    /// At `time` [s], or at the end.
    pub fn at(time: Option<f64>) -> Moment {
        Moment { until: time.unwrap_or(f64::INFINITY), layers: Vec::new(), surfaces: Vec::new() }
    }

    /// The time of the grains shown [s].
    pub fn time(&self) -> Option<f64> {
        let grains = self.layers.iter().filter(|l| l.role == Role::Grains);
        grains.filter_map(|l| l.shown.as_ref()).map(|(time, _)| *time).reduce(f64::max)
    }

    /// Takes walls that move to where they are at the time shown.
    pub fn settle(&mut self) {
        let time = self.time().unwrap_or(0.0);
        for layer in self.layers.iter_mut().filter(|l| l.motion.moves()) {
            let pose = layer.motion.pose(time);
            layer.shown = layer.shown.take().map(|(_, home)| (time, record::moved(&home, &pose)));
        }
    }

    /// Planes and meshes.
    pub fn surfaces(&self) -> &[Surface] {
        &self.surfaces
    }

    /// What to draw.
    pub fn parts(&self) -> Vec<Part<'_>> {
        let shown = self.layers.iter().filter_map(|l| l.shown.as_ref().map(|(_, table)| (l, table)));
        shown
            .map(|(l, table)| Part { role: l.role, name: l.name.clone(), table, kinds: l.kinds.clone() })
            .collect()
    }
}

impl Show for Moment {
    fn layer(&mut self, role: Role, name: &str) -> usize {
        self.layers.push(Layer {
            role,
            name: name.to_owned(),
            kinds: Vec::new(),
            shown: None,
            motion: Motion::default(),
        });
        self.layers.len() - 1
    }

    fn kinds(&mut self, layer: usize, kinds: Vec<String>) {
        self.layers[layer].kinds = kinds;
    }

    fn moves(&mut self, layer: usize, motion: Motion) {
        self.layers[layer].motion = motion;
    }

    fn surface(&mut self, surface: Surface) {
        // Runs of two stages both have the walls near the cut.
        if !self.surfaces.contains(&surface) {
            self.surfaces.push(surface);
        }
    }

    fn push(&mut self, layer: usize, time: f64, table: Table) -> Result<(), ViewError> {
        let shown = &mut self.layers[layer].shown;
        // Without a time asked for, the last frame with anything in it: in the end all grains may have left.
        if self.until.is_infinite() && table.rows() == 0 && shown.is_some() {
            return Ok(());
        }
        let far = |time: f64| (time - self.until).abs();
        let nearer = |(before, _): &(f64, Table)| self.until.is_infinite() || far(time) < far(*before);
        if shown.as_ref().is_none_or(nearer) {
            *shown = Some((time, table));
        }
        Ok(())
    }
}

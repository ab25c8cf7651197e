//! What layers are shown on: a page, one moment, or a series of moments.

use crate::{DrawnTable, Motion, Page, Role, ViewError, WallSurface, WearState};
use record::{ClumpRecord, WallsEnd};
use stream::Table;

/// One thing to show, without its states.
#[derive(Debug, Clone)]
pub struct LayerHead {
    pub role: Role,
    pub name: String,
    /// Names that its field `material` counts.
    pub kinds: Vec<String>,
    /// Shapes of clumps.
    pub clumps: Vec<ClumpRecord>,
    /// Its motion as one body; a layer that moves has one state, that at t = 0.
    pub motion: Motion,
}

impl LayerHead {
    /// A layer at rest, without materials.
    pub fn new(role: Role, name: &str) -> LayerHead {
        LayerHead {
            role,
            name: name.to_owned(),
            kinds: Vec::new(),
            clumps: Vec::new(),
            motion: Motion::default(),
        }
    }

    /// The layer with the columns of one state.
    pub(crate) fn part<'a>(&self, table: &'a Table) -> DrawnTable<'a> {
        let (kinds, clumps) = (self.kinds.clone(), self.clumps.clone());
        DrawnTable { role: self.role, name: self.name.clone(), table, kinds, clumps }
    }
}

/// Whatever shows layers.
pub trait Show {
    /// Adds a layer; its number is for [`Show::push`].
    fn layer(&mut self, head: LayerHead) -> usize;
    /// Adds a wall that is a plane or a mesh; its number is for [`Show::wear`].
    fn surface(&mut self, surface: WallSurface) -> usize;
    /// Colours the parts of walls from `time` [s] on.
    ///
    /// # Errors
    /// A page beyond its limit.
    fn wear(&mut self, time: f64, state: WearState) -> Result<(), ViewError>;
    /// Tells where walls end; what shows no camera does not ask.
    fn walls_end(&mut self, _: WallsEnd) {}
    /// Adds a state of a layer, at `time` [s].
    ///
    /// # Errors
    /// A table without positions, a page beyond its limit, a file that cannot be written.
    fn push(&mut self, layer: usize, time: f64, table: Table) -> Result<(), ViewError>;
}

impl Show for Page {
    fn layer(&mut self, head: LayerHead) -> usize {
        let LayerHead { role, name, kinds, clumps, motion } = head;
        let layer = Page::layer(self, role, &name);
        self.kinds(layer, kinds);
        self.clumps(layer, &clumps);
        self.moves(layer, motion);
        layer
    }

    fn surface(&mut self, surface: WallSurface) -> usize {
        Page::surface(self, surface)
    }

    fn walls_end(&mut self, end: WallsEnd) {
        Page::walls_end(self, end);
    }

    fn wear(&mut self, time: f64, state: WearState) -> Result<(), ViewError> {
        Page::wear(self, time, &state)
    }

    fn push(&mut self, layer: usize, time: f64, table: Table) -> Result<(), ViewError> {
        Page::push(self, layer, time, &table)
    }
}

/// Adds a surface unless it is there: runs of two stages both have the walls near the cut.
pub(crate) fn add_surface(surfaces: &mut Vec<WallSurface>, surface: WallSurface) -> usize {
    surfaces.iter().position(|known| *known == surface).unwrap_or_else(|| {
        surfaces.push(surface);
        surfaces.len() - 1
    })
}

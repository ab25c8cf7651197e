//! What the parts of walls are coloured by at one time.

use crate::ViewError;
use std::sync::Arc;
use stream::{Table, Values};

/// The column of wall spheres that holds it.
pub(crate) const WORN: &str = "wall wear";

/// Values of parts, in the order of the rows of a layer, or of the faces of a mesh.
pub type PartValues = Arc<Vec<f32>>;

/// What the parts of walls are coloured by at one time, in the unit of the field that was asked for.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct WearState {
    /// By the number of a layer of wall spheres.
    pub layers: Vec<(usize, PartValues)>,
    /// By the number of a surface.
    pub surfaces: Vec<(usize, PartValues)>,
}

impl WearState {
    /// The values of the spheres of a layer.
    pub(crate) fn of_layer(&self, layer: usize) -> Option<&PartValues> {
        self.layers.iter().find(|(of, _)| *of == layer).map(|(_, values)| values)
    }

    /// The values of the faces of each of some surfaces.
    pub(crate) fn of_surfaces(&self, count: usize) -> Vec<Option<PartValues>> {
        let mut all = vec![None; count];
        for (surface, values) in &self.surfaces {
            if let Some(own) = all.get_mut(*surface) {
                *own = Some(values.clone());
            }
        }
        all
    }

    /// Writes the values of a layer into its table.
    ///
    /// # Errors
    /// As many values as rows are not there.
    pub(crate) fn fill(&self, layer: usize, table: &mut Table) -> Result<(), ViewError> {
        let Some(values) = self.of_layer(layer) else { return Ok(()) };
        let column = Values::F32(values.to_vec());
        table.replace(WORN, column).map_err(|e| ViewError::Table { why: e.to_string() })
    }
}

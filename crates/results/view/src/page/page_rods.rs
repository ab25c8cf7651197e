//! What the rods of a page mean: arrows, force chains, outlines.

use super::{Page, PageLayer, PageOptions};
use crate::appearance::scale;
use crate::picture::ArrowKey;
use crate::things::chains::{self, NORMAL_FORCE, THICKEST, end_of_scale};
use crate::things::extras;
use crate::{Map, Role, picture};
use serde_json::{Value, json};

impl Page {
    pub(super) fn has_rods(&self) -> bool {
        self.layers.iter().any(|l| l.role.is_rods())
    }

    pub(super) fn has_chains(&self) -> bool {
        self.layers.iter().any(|l| l.role == Role::ForceChains)
    }

    /// Size of the grains as drawn at first [–].
    pub(super) fn size_of_grains(&self) -> f64 {
        match self.layers.iter().any(|l| l.role.lies_in_grains()) {
            _ if self.has_chains() => chains::GRAINS,
            true => extras::GRAINS,
            false => 1.0,
        }
    }
}

/// Adds to the header of a layer what its rods mean.
pub(super) fn add_to(packed: &mut Value, layer: &PageLayer, options: &PageOptions) {
    packed["arrows"] = json!(layer.arrow_key().map(|key| arrow_json(&key)));
    match layer.role {
        Role::ForceChains => packed["chains"] = chains_json(layer, options),
        Role::Outline(kind) => packed["colour"] = json!(kind.colour()),
        _ => {}
    }
}

/// What thickness and colour of force chains mean.
fn chains_json(layer: &PageLayer, options: &PageOptions) -> Value {
    let field = layer.fields.iter().find(|f| f.name == NORMAL_FORCE);
    let [most, all] = field.map_or([[0.0; 2]; 2], |f| [f.most, f.all].map(|r| [r.lo, r.hi]));
    let hi = end_of_scale(most[0].abs().max(most[1].abs()));
    let shown = options.range.unwrap_or([0.0, hi]);
    let (unit, factor) = scale::readable("N", shown[1]);
    let map = Map::ALL.iter().find(|(_, m)| *m == options.map).map(|(name, _)| *name);
    json!({
        "name": "normal force", "unit": unit, "factor": factor, "shown": shown, "all": all,
        "map": map, "pull": picture::PULL, "radius": THICKEST * layer.reach[1],
    })
}

fn arrow_json(key: &ArrowKey) -> Value {
    let (unit, factor) = scale::readable(key.of.unit(), key.example);
    json!({
        "word": key.of.word(), "unit": unit, "factor": factor,
        "example": key.example, "scale": key.scale, "radius": key.radius,
    })
}

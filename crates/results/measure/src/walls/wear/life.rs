//! How deep walls are worn, how fast, and how long they last, from the sliding work on them ([`Archard`]).

use crate::definition::{AskError, Asked};
use crate::sheet::Head;
use crate::{MeasureError, Run};
use wear::Archard;

/// Millimetres in a metre.
const MM: f64 = 1e3;

/// Coefficients of materials, and the thickness that is to be worn.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct WearLife {
    /// Of a material by name, or of all others.
    coefficients: Vec<(Option<String>, f64)>,
    /// [m]
    thickness: Option<f64>,
}

/// Depth [mm], rate [mm/1000 h], and life [h] of a part.
pub(super) type Worn = [f64; 3];

impl WearLife {
    /// What was asked for; none without coefficients.
    pub fn asked_for(asked: &Asked) -> Result<Option<WearLife>, AskError> {
        let usage = |text: &str| Err(AskError::Usage(text.to_owned()));
        let coefficients = asked.wear_coefficients.clone();
        if coefficients.is_empty() {
            return match asked.thickness {
                Some(_) => {
                    usage("--thickness: the time that it lasts needs --wear-coefficient, such as 1e-13")
                }
                None => Ok(None),
            };
        }
        let twice = |k: usize| coefficients[..k].iter().any(|(name, _)| *name == coefficients[k].0);
        if let Some(k) = (0..coefficients.len()).find(|k| twice(*k)) {
            let of = coefficients[k].0.as_ref().map_or_else(String::new, |name| format!(" of '{name}'"));
            return usage(&format!("--wear-coefficient{of} is given twice: leave one out"));
        }
        if asked.cell.is_some() && coefficients.iter().any(|(name, _)| name.is_some()) {
            return usage(
                "--wear-coefficient NAME=K: a cell of --cell may hold walls of several materials: give one K, and --wall NAME",
            );
        }
        Ok(Some(WearLife { coefficients, thickness: asked.thickness }))
    }

    /// Heads of its columns.
    pub fn heads(&self) -> Vec<Head> {
        let mut pairs = vec![("depth", "mm"), ("rate", "mm/1000 h")];
        pairs.extend(self.thickness.map(|_| ("life", "h")));
        Head::list(&pairs)
    }

    /// Whether all names are those of materials of the run.
    ///
    /// # Errors
    /// A name that is none of them.
    pub fn check(&self, run: &Run) -> Result<(), MeasureError> {
        let unknown = self.coefficients.iter().filter_map(|(name, _)| name.as_ref());
        match unknown.into_iter().find(|name| !run.materials.contains(name)) {
            Some(name) => Err(MeasureError::Material { name: (*name).clone(), has: run.materials.clone() }),
            None => Ok(()),
        }
    }

    /// The coefficient of a wall [m³/J]; of all walls where none is named. None where its material has none.
    pub fn of(&self, run: &Run, wall: Option<usize>) -> Option<Archard> {
        let index = wall.and_then(|wall| run.wall_materials.get(wall).copied().flatten());
        let material = index.and_then(|k| run.materials.get(k));
        let named = self.coefficients.iter().find(|(name, _)| name.is_some() && name.as_ref() == material);
        let found = named.or_else(|| self.coefficients.iter().find(|(name, _)| name.is_none()));
        found.map(|(_, coefficient)| Archard { coefficient: *coefficient })
    }

    /// Depth, rate and life where a sliding work per area [J/m²] took a time of this length [s]; NaN where it is not known.
    pub fn worn(&self, by: Option<Archard>, work_per_area: f64, length: f64) -> Worn {
        let Some(archard) = by.filter(|_| length > 0.0) else { return [f64::NAN; 3] };
        let depth = archard.depth(work_per_area);
        let life = self.thickness.map_or(f64::NAN, |thickness| Archard::life(thickness, depth, length));
        [MM * depth, MM * Archard::rate(depth, length), life]
    }

    /// How many of the numbers of a part are columns.
    pub fn columns(&self) -> usize {
        if self.thickness.is_some() { 3 } else { 2 }
    }

    /// In words: what a depth is made with.
    pub fn words(&self, length: f64) -> String {
        let of = |(name, k): &(Option<String>, f64)| match name {
            Some(name) => format!("{k:e} m³/J of '{name}'"),
            None if self.coefficients.len() > 1 => format!("{k:e} m³/J of the others"),
            None => format!("{k:e} m³/J"),
        };
        let all: Vec<String> = self.coefficients.iter().map(of).collect();
        format!(
            "depth: worn volume per sliding work {}; rate: as in these {} s without pause",
            all.join(", "),
            geom::Shown(length)
        )
    }
}

//! Shows only some of the grains: those whose field has a wanted value.

use crate::appearance::field;
use crate::{LayerHead, Role, Show, ViewError, WallSurface, WearState};
use stream::Table;

/// Which grains are shown.
#[derive(Debug, Clone, PartialEq)]
pub struct Only {
    pub field: String,
    pub wanted: Wanted,
}

/// The wanted values of a field.
#[derive(Debug, Clone, PartialEq)]
pub enum Wanted {
    /// From the first to the second [SI], both included.
    Between(f64, f64),
    /// The number of this material.
    Material(String),
}

/// Shows the wanted grains of all layers of grains, and everything else, on something else.
pub struct Chosen<'a, S> {
    only: Option<Only>,
    show: &'a mut S,
    /// Of each layer: its materials, where it has grains.
    layers: Vec<Option<Vec<String>>>,
    /// Grains that were shown, and all of the layers that have the field, in all frames.
    counts: [usize; 2],
    /// Fields of a layer of grains that does not have it.
    without: Option<Vec<String>>,
}

impl<'a, S: Show> Chosen<'a, S> {
    /// Without `only` all grains are shown.
    pub fn new(only: Option<Only>, show: &'a mut S) -> Chosen<'a, S> {
        Chosen { only, show, layers: Vec::new(), counts: [0; 2], without: None }
    }

    /// Grains that were shown, and all, in all frames.
    pub fn counts(&self) -> [usize; 2] {
        self.counts
    }

    /// Refuses a field that no layer of grains has.
    ///
    /// # Errors
    /// There are grains, and none has it.
    pub fn check(&self) -> Result<(), ViewError> {
        match (&self.only, &self.without, self.counts) {
            (Some(only), Some(known), [_, 0]) => {
                let name = field::canonical(&only.field).to_owned();
                Err(ViewError::NoField { what: "only", name, known: known.clone() })
            }
            _ => Ok(()),
        }
    }

    /// Rows of the wanted grains; `None`: the table does not have the field, and is shown whole.
    fn chosen(&self, only: &Only, kinds: &[String], table: &Table) -> Result<Option<Vec<u32>>, ViewError> {
        let Some(values) = field::values(table, field::canonical(&only.field)) else { return Ok(None) };
        let [low, high] = match &only.wanted {
            Wanted::Between(low, high) => [*low, *high],
            Wanted::Material(of) => match kinds.iter().position(|kind| kind == of) {
                Some(number) => [number as f64; 2],
                None => return Err(ViewError::NoMaterial { name: of.clone(), known: kinds.to_vec() }),
            },
        };
        let rows = values.iter().enumerate().filter(|(_, v)| (low..=high).contains(*v));
        Ok(Some(rows.map(|(row, _)| row as u32).collect()))
    }
}

impl<S: Show> Show for Chosen<'_, S> {
    fn layer(&mut self, head: LayerHead) -> usize {
        let layer = self.show.layer(head.clone());
        self.layers.resize(self.layers.len().max(layer + 1), None);
        self.layers[layer] = (head.role == Role::Grains).then_some(head.kinds);
        layer
    }

    fn surface(&mut self, surface: WallSurface) -> usize {
        self.show.surface(surface)
    }

    fn wear(&mut self, time: f64, state: WearState) -> Result<(), ViewError> {
        self.show.wear(time, state)
    }

    fn push(&mut self, layer: usize, time: f64, table: Table) -> Result<(), ViewError> {
        let (Some(only), Some(Some(kinds))) = (&self.only, self.layers.get(layer)) else {
            return self.show.push(layer, time, table);
        };
        let Some(rows) = self.chosen(only, kinds, &table)? else {
            self.without = Some(field::known(&table));
            return self.show.push(layer, time, table);
        };
        self.counts = [self.counts[0] + rows.len(), self.counts[1] + table.rows()];
        self.show.push(layer, time, table.select(&rows))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stream::Values;

    /// What was pushed.
    #[derive(Default)]
    struct Seen(Vec<(usize, Vec<f64>)>, usize);

    impl Show for Seen {
        fn layer(&mut self, _: LayerHead) -> usize {
            self.1 += 1;
            self.1 - 1
        }

        fn surface(&mut self, _: WallSurface) -> usize {
            0
        }

        fn wear(&mut self, _: f64, _: WearState) -> Result<(), ViewError> {
            Ok(())
        }

        fn push(&mut self, layer: usize, _: f64, table: Table) -> Result<(), ViewError> {
            self.0.push((layer, table.get("x").map(Values::to_f64).unwrap_or_default()));
            Ok(())
        }
    }

    fn grains() -> Table {
        let mut table = Table::default();
        table.push("x", Values::F64(vec![1.0, 2.0, 3.0])).expect("fits");
        table.push("material", Values::U32(vec![0, 1, 1])).expect("fits");
        table
    }

    fn shown(field: &str, wanted: Wanted) -> Result<(Seen, [usize; 2]), ViewError> {
        let mut seen = Seen::default();
        let mut chosen = Chosen::new(Some(Only { field: field.to_owned(), wanted }), &mut seen);
        let walls = chosen.layer(LayerHead::new(Role::Walls, "walls"));
        let kinds = vec!["soil".to_owned(), "rock".to_owned()];
        let of = chosen.layer(LayerHead { kinds, ..LayerHead::new(Role::Grains, "grains") });
        chosen.push(walls, 0.0, grains())?;
        chosen.push(of, 0.0, grains())?;
        chosen.check()?;
        let counts = chosen.counts();
        Ok((seen, counts))
    }

    #[test]
    fn grains_are_chosen_and_walls_stay() {
        let (seen, counts) = shown("material", Wanted::Material("rock".to_owned())).unwrap();
        assert_eq!((seen.0, counts), (vec![(0, vec![1.0, 2.0, 3.0]), (1, vec![2.0, 3.0])], [2, 3]));
        let (seen, counts) = shown("x", Wanted::Between(1.0, 2.0)).unwrap();
        assert_eq!((seen.0[1].1.clone(), counts), (vec![1.0, 2.0], [2, 3]));
    }

    #[test]
    fn what_is_not_there_is_named() {
        let of = |field: &str, wanted| shown(field, wanted).err().map(|e| e.to_string()).unwrap_or_default();
        assert!(
            of("material", Wanted::Material("clay".into()))
                .contains("no material 'clay' here: choose one of soil, rock")
        );
        assert!(of("cluster", Wanted::Between(1.0, 2.0)).contains("only: no field 'cluster' here"));
    }
}

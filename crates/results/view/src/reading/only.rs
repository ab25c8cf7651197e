//! Shows only some of the grains: those whose field has a wanted value.

use crate::appearance::field;
use crate::{Hidden, LayerHead, Role, Show, ViewError, WallSurface, WearState};
use record::WallsEnd;
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

/// Passes on to another [`Show`] the wanted grains of each layer, and all that is no grain.
pub struct Chosen<'a, S> {
    /// A grain is shown if it has a wanted value of each field.
    only: Vec<Only>,
    show: &'a mut S,
    /// Of each layer: its materials, where it has grains.
    layers: Vec<Option<Vec<String>>>,
    /// Over all frames: grains shown, and grains in layers that have a field to choose by.
    counts: [usize; 2],
    /// For each choice, whether a layer of grains has its field.
    found: Vec<bool>,
    /// The fields of a layer of grains that lacks one of the choices.
    without: Option<Vec<String>>,
    /// What was added, by name.
    names: (Vec<(Role, String)>, Vec<String>),
}

impl<'a, S: Show> Chosen<'a, S> {
    /// Without `only` all grains are shown.
    pub fn new(only: Vec<Only>, show: &'a mut S) -> Chosen<'a, S> {
        let found = vec![false; only.len()];
        Chosen {
            only,
            show,
            layers: Vec::new(),
            counts: [0; 2],
            found,
            without: None,
            names: Default::default(),
        }
    }

    /// Grains shown, and all grains, over all frames.
    pub fn counts(&self) -> [usize; 2] {
        self.counts
    }

    /// Refuses a field that no layer of grains has, and a name to hide that nothing has.
    ///
    /// # Errors
    /// There are grains, and none has it; a name that nothing has.
    pub fn check(&self, hidden: &Hidden) -> Result<(), ViewError> {
        hidden.check(&self.names.0, &self.names.1)?;
        let missing = self.only.iter().zip(&self.found).find(|(_, found)| !**found);
        match (missing, &self.without) {
            (Some((only, _)), Some(known)) => {
                let name = field::canonical(&only.field).to_owned();
                Err(ViewError::NoField { what: "only", name, known: known.clone() })
            }
            _ => Ok(()),
        }
    }

    /// Rows of the wanted grains; `None` where the table lacks all of the fields and is shown whole.
    fn chosen(&mut self, kinds: &[String], table: &Table) -> Result<Option<Vec<u32>>, ViewError> {
        let mut wanted: Option<Vec<bool>> = None;
        for (only, found) in self.only.iter().zip(&mut self.found) {
            let Some(values) = field::values(table, field::canonical(&only.field)) else {
                self.without = Some(field::known(table));
                continue;
            };
            *found = true;
            let [low, high] = only.ends(kinds)?;
            let stays = wanted.get_or_insert_with(|| vec![true; values.len()]);
            stays.iter_mut().zip(&values).for_each(|(stays, v)| *stays &= (low..=high).contains(v));
        }
        let rows =
            |stays: Vec<bool>| (0..).zip(stays).filter(|(_, stays)| *stays).map(|(row, _)| row).collect();
        Ok(wanted.map(rows))
    }
}

impl Only {
    /// The wanted values, from the first to the second.
    fn ends(&self, kinds: &[String]) -> Result<[f64; 2], ViewError> {
        match &self.wanted {
            Wanted::Between(low, high) => Ok([*low, *high]),
            Wanted::Material(of) => match kinds.iter().position(|kind| kind == of) {
                Some(number) => Ok([number as f64; 2]),
                None => Err(ViewError::NoMaterial { name: of.clone(), known: kinds.to_vec() }),
            },
        }
    }
}

impl<S: Show> Show for Chosen<'_, S> {
    fn layer(&mut self, head: LayerHead) -> usize {
        let layer = self.show.layer(head.clone());
        self.names.0.push((head.role, head.name.clone()));
        self.layers.resize(self.layers.len().max(layer + 1), None);
        self.layers[layer] = (head.role == Role::Grains).then_some(head.kinds);
        layer
    }

    fn surface(&mut self, surface: WallSurface) -> usize {
        self.names.1.push(surface.name.clone());
        self.show.surface(surface)
    }

    fn walls_end(&mut self, end: WallsEnd) {
        self.show.walls_end(end);
    }

    fn wear(&mut self, time: f64, state: WearState) -> Result<(), ViewError> {
        self.show.wear(time, state)
    }

    fn push(&mut self, layer: usize, time: f64, table: Table) -> Result<(), ViewError> {
        let kinds = self.layers.get(layer).cloned().flatten().filter(|_| !self.only.is_empty());
        let Some(kinds) = kinds else { return self.show.push(layer, time, table) };
        let Some(rows) = self.chosen(&kinds, &table)? else {
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
        shown_by(vec![Only { field: field.to_owned(), wanted }])
    }

    fn shown_by(only: Vec<Only>) -> Result<(Seen, [usize; 2]), ViewError> {
        let mut seen = Seen::default();
        let mut chosen = Chosen::new(only, &mut seen);
        let walls = chosen.layer(LayerHead::new(Role::Walls, "walls"));
        let kinds = vec!["soil".to_owned(), "rock".to_owned()];
        let of = chosen.layer(LayerHead { kinds, ..LayerHead::new(Role::Grains, "grains") });
        chosen.push(walls, 0.0, grains())?;
        chosen.push(of, 0.0, grains())?;
        chosen.check(&Hidden::default())?;
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
    fn of_several_ranges_a_grain_must_be_in_each() {
        let only =
            |field: &str, low, high| Only { field: field.to_owned(), wanted: Wanted::Between(low, high) };
        let (seen, counts) = shown_by(vec![only("x", 1.0, 2.0), only("material", 1.0, 1.0)]).unwrap();
        assert_eq!((seen.0[1].1.clone(), counts), (vec![2.0], [1, 3]));
        let refused = shown_by(vec![only("x", 1.0, 2.0), only("y", 0.0, 1.0)]).err().expect("refused");
        assert!(refused.to_string().contains("only: no field 'y' here"), "{refused}");
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

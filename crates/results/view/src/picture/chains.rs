//! Force chains: thickness and colour of a contact go by its normal force.

use super::{
    key::BarKey,
    options::PictureOptions,
    rod::{Rod, RodShape},
    shapes,
};
use crate::appearance::{
    colour::{self, Rgb},
    scale::Range,
};
use crate::things::{
    bodies::{counted, grouped},
    chains::{COUNTS, FORCES, MOST, NORMAL_FORCE, THICKEST, end_of_scale},
};
use geom::Vec3;
use record::column::RADIUS;
use stream::{Table, Values};

/// Colour of contacts that pull.
pub(crate) const PULL: Rgb = [0x1f, 0x77, 0xd4];

/// A pull below this share of the largest force is rounding [–].
const ROUNDING: f64 = 1e-9;

/// What was seen of all contacts that are to be drawn.
#[derive(Clone, Default)]
pub(super) struct ChainSurvey {
    /// Sizes of normal forces [N].
    sizes: Vec<f64>,
    all: Option<Range>,
    pulls: bool,
    radii: [f64; 2],
    /// Most contacts of a moment.
    most: usize,
}

/// What thickness and colour mean.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ChainKey {
    pub bar: BarKey,
    /// Radius of the rod of a force at the end of the scale [m].
    radius: f64,
    /// Whether a contact pulls at any moment.
    pub pulls: bool,
    /// Most contacts of a moment.
    most: usize,
}

/// The contacts of a moment that are drawn, and all of them.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct ChainCount {
    pub drawn: usize,
    pub all: usize,
    /// Sums of the sizes of their normal forces [N].
    pub force: [f64; 2],
}

impl ChainSurvey {
    /// Takes in a moment.
    pub fn add(&mut self, table: &Table) {
        let forces = forces(table);
        let of = Range::of(forces.iter().map(|force| force.abs()));
        self.all = Some(self.all.map_or(of, |all| all.with(of)));
        let largest = forces.iter().fold(0.0, |most: f64, force| most.max(force.abs()));
        self.pulls |= forces.iter().any(|force| *force < -ROUNDING * largest);
        self.most = self.most.max(ChainCount::of(table).all);
        self.sizes.extend(forces.iter().map(|force| force.abs()));
        for radius in table.get(RADIUS).into_iter().flat_map(Values::iter) {
            self.radii = [self.radii[0] + radius, self.radii[1] + 1.0];
        }
    }

    /// Whether there was a moment with contacts, or with none at all.
    pub fn is_seen(&self) -> bool {
        self.all.is_some()
    }

    /// The scale goes from 0 to what 98 % of the contacts do not exceed; none where no contacts are shown.
    pub fn key(&self, options: &PictureOptions) -> Option<ChainKey> {
        let all = self.all?;
        let most = Range::of_most(&self.sizes).hi;
        let hi = end_of_scale(most);
        let range = options.range.map_or(Range { lo: 0.0, hi }, |[lo, hi]| Range { lo, hi });
        let beyond = [all.lo < range.lo * (1.0 - 1e-9), all.hi > range.hi * (1.0 + 1e-9)];
        let (title, map) = ("normal force".to_owned(), options.map);
        let bar = BarKey { title, unit: "N", range, beyond, log: false, map };
        let radius = THICKEST * self.radii[0] / self.radii[1].max(1.0);
        Some(ChainKey { bar, radius, pulls: self.pulls, most: self.most })
    }
}

impl ChainKey {
    /// The contacts of a moment as rods, and how many there are.
    pub fn rods(&self, table: &Table) -> (Vec<Rod>, ChainCount) {
        let rod = |((middle, half, _), force): ((Vec3, Vec3, f64), &f64)| Rod {
            ends: [middle - half, middle + half],
            radii: [self.radius(*force); 2],
            shape: RodShape::Cone,
            colour: self.colour(*force),
        };
        let rods = shapes::rows(table).into_iter().zip(&forces(table)).map(rod).collect();
        (rods, ChainCount::of(table))
    }

    /// Radius of the rod of a force [m]: proportional to it.
    fn radius(&self, force: f64) -> f64 {
        self.radius * (force.abs() / self.bar.range.hi.abs().max(f64::MIN_POSITIVE)).min(1.0)
    }

    fn colour(&self, force: f64) -> [f32; 3] {
        match force < 0.0 {
            true => colour::fraction(PULL),
            false => self.bar.map.at(self.bar.range.share(force)),
        }
    }

    /// The longest that [`ChainCount::words`] are at any moment.
    pub fn longest(&self) -> String {
        let [drawn, all] = [self.most.min(MOST), self.most];
        ChainCount { drawn, all, force: [0.0, 1.0] }.words()
    }
}

impl ChainCount {
    fn of(table: &Table) -> ChainCount {
        let first = |name: &str| table.get(name).filter(|v| !v.is_empty()).map_or(0.0, |v| v.get(0));
        let [drawn, all] = COUNTS.map(|name| first(name) as usize);
        ChainCount { drawn, all, force: FORCES.map(first) }
    }

    /// "420 contacts", or which of them are drawn.
    pub fn words(&self) -> String {
        if self.drawn == self.all {
            return counted(self.all, "contacts");
        }
        let share = (100.0 * self.force[0] / self.force[1]).floor();
        format!(
            "the {} strongest of {}: {share:.0} % of the force",
            grouped(self.drawn),
            counted(self.all, "contacts")
        )
    }

    /// Both together.
    #[must_use]
    pub fn plus(self, other: ChainCount) -> ChainCount {
        ChainCount {
            drawn: self.drawn + other.drawn,
            all: self.all + other.all,
            force: [0, 1].map(|k| self.force[k] + other.force[k]),
        }
    }
}

/// The normal force of each rod [N].
fn forces(table: &Table) -> Vec<f64> {
    table.get(NORMAL_FORCE).map(Values::to_f64).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::things::extras::ALONG;
    use record::column::POSITION;

    /// Rods with these normal forces.
    fn table(forces: &[f32], all: usize, total: f64) -> Table {
        let mut table = Table::with_rows(forces.len());
        for name in POSITION.into_iter().chain(ALONG).chain([RADIUS]) {
            table.push(name, Values::F64(vec![0.01; forces.len()])).expect("fits");
        }
        table.push(NORMAL_FORCE, Values::F32(forces.to_vec())).expect("fits");
        let sum = forces.iter().map(|f| f64::from(f.abs())).sum();
        for (name, value) in
            COUNTS.into_iter().chain(FORCES).zip([forces.len() as f64, all as f64, sum, total])
        {
            table.push(name, Values::F64(vec![value; forces.len()])).expect("fits");
        }
        table
    }

    fn drawn(table: &Table, range: Option<[f64; 2]>) -> (ChainKey, Vec<Rod>, ChainCount) {
        let mut survey = ChainSurvey::default();
        survey.add(table);
        let options = PictureOptions { range, ..PictureOptions::default() };
        let key = survey.key(&options).expect("contacts");
        let (rods, count) = key.rods(table);
        (key, rods, count)
    }

    /// Thickness is force: where none is beyond the scale, the rods add up to what was recorded.
    #[test]
    fn the_thickness_of_all_rods_adds_up_to_the_force_recorded() {
        let forces: Vec<f32> = (0..60).map(|k| 0.5 * k as f32 + 1.0).collect();
        let recorded: f64 = forces.iter().map(|f| f64::from(*f)).sum();
        let (key, rods, count) = drawn(&table(&forces, 60, recorded), Some([0.0, 50.0]));
        let newtons = rods.iter().map(|rod| rod.radii[0]).sum::<f64>() * key.bar.range.hi / (THICKEST * 0.01);
        assert!((newtons - recorded).abs() < 1e-6 * recorded, "{newtons} N drawn of {recorded} N");
        assert_eq!((key.bar.beyond, count.words()), ([false; 2], "60 contacts".to_owned()));
    }

    #[test]
    fn what_is_left_out_is_told() {
        let (_, _, count) = drawn(&table(&[3.0, 4.0], 1200, 9.0), None);
        assert_eq!(count.words(), "the 2 strongest of 1 200 contacts: 77 % of the force");
        let (key, rods, count) = drawn(&table(&[], 0, 0.0), None);
        assert_eq!((rods.len(), count.words(), key.bar.range.hi), (0, "0 contacts".to_owned(), 1.0));
    }

    #[test]
    fn contacts_that_pull_have_a_colour_of_their_own() {
        let (key, rods, _) = drawn(&table(&[-2.0, 2.0], 2, 4.0), None);
        assert!(key.pulls && rods[0].colour == colour::fraction(PULL));
        assert!(rods[0].radii == rods[1].radii && rods[1].colour != rods[0].colour);
    }
}

//! A region as a table gives it, and a property that changes along a column of the cloud, in steps.
//!
//! ```toml
//! [[region]]
//! name = "worn"
//! column = "intensity"
//! values = [0, 255]
//! friction = [0.3, 0.8]    # at the smallest and at the largest value, linear between
//! steps = 16               # so many regions, each with a separate material
//! ```
//!
//! A step has the value in its middle: the largest error is the difference of the two ends over twice the number of steps.

use super::error::RegionsError;
use serde::{Deserialize, Serialize};

/// Steps where none are given.
const STEPS: u32 = 16;
/// Most steps: each is a material.
const MOST_STEPS: u32 = 64;

/// A region of the table.
#[derive(Deserialize, Clone)]
#[serde(deny_unknown_fields)]
pub(crate) struct Region {
    #[serde(default)]
    pub name: String,
    pub shape: Option<String>,
    pub column: Option<String>,
    pub values: Option<OneOrTwo>,
    pub steps: Option<u32>,
    pub roughness: Option<OneOrTwo>,
    pub material: Option<String>,
    pub young: Option<OneOrTwo>,
    pub poisson: Option<OneOrTwo>,
    pub friction: Option<OneOrTwo>,
    pub restitution: Option<OneOrTwo>,
    pub velocity: Option<[f64; 3]>,
    /// The range of which this region is a step.
    #[serde(skip)]
    pub whole: Option<[f64; 2]>,
}

/// One value, or the smallest and the largest.
#[derive(Deserialize, Clone, Copy)]
#[serde(untagged)]
pub(crate) enum OneOrTwo {
    One(f64),
    Two([f64; 2]),
}

impl OneOrTwo {
    /// The value; of two, the first.
    pub fn first(self) -> f64 {
        match self {
            OneOrTwo::One(value) | OneOrTwo::Two([value, _]) => value,
        }
    }

    fn ends(self) -> Option<[f64; 2]> {
        match self {
            OneOrTwo::One(_) => None,
            OneOrTwo::Two(ends) => Some(ends),
        }
    }

    /// A share of the way from the first to the second.
    fn at(self, share: f64) -> OneOrTwo {
        match self {
            OneOrTwo::One(_) => self,
            OneOrTwo::Two([a, b]) => OneOrTwo::One(a + share * (b - a)),
        }
    }
}

/// A property that changes along a column, for the report.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Stepped {
    /// Name of the region.
    pub region: String,
    /// The property, such as `friction`.
    pub property: &'static str,
    pub column: String,
    pub steps: u32,
    /// Largest error of the steps, in the unit of the property.
    pub error: f64,
}

impl Region {
    /// The properties, those of the material first.
    fn properties(&self) -> [(&'static str, Option<OneOrTwo>); 5] {
        [
            ("friction", self.friction),
            ("restitution", self.restitution),
            ("young", self.young),
            ("poisson", self.poisson),
            ("roughness", self.roughness),
        ]
    }

    /// The steps of a region with a property that changes along its column; the region itself when there is none. `outside` is the name of
    /// the material outside of all regions.
    pub fn steps(
        self,
        place: &str,
        outside: &str,
        report: &mut Vec<Stepped>,
    ) -> Result<Vec<Region>, RegionsError> {
        let ends = |(name, value): (&'static str, Option<OneOrTwo>)| value?.ends().map(|ends| (name, ends));
        let changing: Vec<(&str, [f64; 2])> = self.properties().into_iter().filter_map(ends).collect();
        let place = || place.to_owned();
        let Some(&(property, _)) = changing.first() else {
            return if self.steps.is_some() {
                Err(RegionsError::StepsOfNothing { place: place() })
            } else {
                Ok(vec![self])
            };
        };
        let range = self.values.and_then(OneOrTwo::ends).filter(|[low, high]| low < high);
        let (Some(column), Some(range)) = (&self.column, range) else {
            return Err(RegionsError::AlongNothing { place: place(), property });
        };
        let steps = self.steps.unwrap_or(STEPS);
        if !(2..=MOST_STEPS).contains(&steps) {
            return Err(RegionsError::Steps { place: place(), steps, most: MOST_STEPS });
        }
        report.extend(changing.iter().map(|&(property, [a, b])| Stepped {
            region: self.name.clone(),
            property,
            column: column.clone(),
            steps,
            error: 0.5 * (b - a).abs() / f64::from(steps),
        }));
        Ok((0..steps).map(|k| self.step(k, steps, range, outside)).collect())
    }

    fn step(&self, k: u32, steps: u32, range: [f64; 2], outside: &str) -> Region {
        let share = |k: f64| k / f64::from(steps);
        let value = |k: u32| {
            if k == steps { range[1] } else { range[0] + share(f64::from(k)) * (range[1] - range[0]) }
        };
        let middle = |property: Option<OneOrTwo>| property.map(|p| p.at(share(f64::from(k) + 0.5)));
        let of_material = self.properties().into_iter().take(4).any(|(_, value)| value.is_some());
        let named = match (&self.material, self.name.is_empty()) {
            (Some(name), _) => name.clone(),
            (None, true) => outside.to_owned(),
            (None, false) => format!("{outside}-{}", self.name),
        };
        Region {
            values: Some(OneOrTwo::Two([value(k), value(k + 1)])),
            steps: None,
            roughness: middle(self.roughness),
            young: middle(self.young),
            poisson: middle(self.poisson),
            friction: middle(self.friction),
            restitution: middle(self.restitution),
            material: if of_material { Some(format!("{named}-{}", k + 1)) } else { self.material.clone() },
            whole: Some(range),
            ..self.clone()
        }
    }
}

//! The extent of a scene, and how it is strained.

use super::unit;
use serde::Deserialize;

/// `[domain]`
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Domain {
    /// Periodic axes.
    #[serde(default)]
    pub periodic: Vec<Axis>,
    /// Lowest corner [m].
    #[serde(default, deserialize_with = "unit::metres")]
    pub low: Option<[f64; 3]>,
    /// Highest corner [m].
    #[serde(default, deserialize_with = "unit::metres")]
    pub high: Option<[f64; 3]>,
    /// A run whose last domain it is, instead of `low` and `high`.
    pub source: Option<String>,
    /// What periodic axes follow.
    #[serde(default)]
    pub strain: Strains,
    /// What becomes of particles that have fallen past all walls.
    #[serde(default)]
    pub outside: Outside,
}

/// `domain.outside`
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Outside {
    /// They fall on.
    #[default]
    Keep,
    /// An outlet below the walls takes them out.
    Remove,
}

/// `domain.strain`: what each axis follows.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Strains {
    /// Along x.
    pub x: Option<Strain>,
    /// Along y.
    pub y: Option<Strain>,
    /// Along z.
    pub z: Option<Strain>,
}

impl Strains {
    /// Of all axes, with their names.
    pub fn axes(&self) -> [(&'static str, Option<&Strain>); 3] {
        [("x", self.x.as_ref()), ("y", self.y.as_ref()), ("z", self.z.as_ref())]
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.axes().iter().all(|(_, strain)| strain.is_none())
    }
}

/// What an axis of the domain follows; compression is positive.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Strain {
    /// Rate of logarithmic strain [1/s]; this, `stress` or `path`.
    #[serde(default, deserialize_with = "unit::a_second")]
    pub rate: Option<f64>,
    /// Mean stress of contacts and bonds [Pa]; this, `rate` or `path`.
    #[serde(default, deserialize_with = "unit::pascals")]
    pub stress: Option<f64>,
    /// A table of strain or stress over time; this, `rate` or `stress`.
    pub path: Option<StrainPath>,
    /// Largest rate of strain with which a stress is followed [1/s].
    #[serde(default, deserialize_with = "unit::a_second")]
    pub rate_limit: Option<f64>,
}

/// A table of strain or stress over time.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StrainPath {
    /// CSV with the column t [s], and strain [–] or stress [Pa].
    pub source: String,
}

/// An axis of space.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
#[allow(missing_docs)]
pub enum Axis {
    X,
    Y,
    Z,
}

//! What a key of a scene is: its dimension, from the unit that the page gives it, and how it turns with the frame.

use scene::keys::rows;
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// Powers of length, mass and time.
pub type Dimension = [i32; 3];

/// How a value turns with the frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// It does not.
    Number,
    /// A vector.
    Vector,
    /// An axial vector: a mirror reverses it as well.
    Axial,
    /// A point.
    Point,
    /// A point and a normal.
    Plane,
    /// Two corners of a box.
    Corners,
    /// A shape: a table of its name and numbers.
    Shape,
    /// Spheres of a clump: a point and a radius each, in the frame of the clump.
    Spheres,
    /// Names of axes.
    Axes,
    /// Names of faces of a box.
    Faces,
    /// An orientation.
    Orientation,
    /// Volume, centre and inertia of a clump.
    Moments,
}

/// Dimension and kind of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Meaning {
    /// Its dimension.
    pub dimension: Dimension,
    /// How it turns.
    pub kind: Kind,
}

/// Symbols of units.
const SYMBOLS: [(&str, Dimension); 10] = [
    ("m", [1, 0, 0]),
    ("kg", [0, 1, 0]),
    ("s", [0, 0, 1]),
    ("rpm", [0, 0, -1]),
    ("N", [1, 1, -2]),
    ("Pa", [-1, 1, -2]),
    ("J", [2, 1, -2]),
    ("Hz", [0, 0, -1]),
    ("rad", [0; 3]),
    ("1", [0; 3]),
];

/// The dimension of a unit such as "N s/m".
///
/// # Panics
/// At a symbol that is none of [`SYMBOLS`].
pub fn dimension(unit: &str) -> Dimension {
    let mut sum = [0; 3];
    for (part, sign) in unit.split('/').zip([1].into_iter().chain(std::iter::repeat(-1))) {
        for word in part.split([' ', '·']).filter(|w| !w.is_empty()) {
            let powers = [('²', 2), ('³', 3), ('⁵', 5)];
            let power = powers.iter().find(|p| word.ends_with(p.0));
            let symbol = power.map_or(word, |p| word.trim_end_matches(p.0));
            let known = SYMBOLS.iter().find(|s| s.0 == symbol);
            let known =
                known.unwrap_or_else(|| panic!("the unit '{unit}' has the unknown symbol '{symbol}'"));
            (0..3).for_each(|k| sum[k] += sign * power.map_or(1, |p| p.1) * known.1[k]);
        }
    }
    sum
}

const NONE: Dimension = [0; 3];
const LENGTH: Dimension = [1, 0, 0];

/// Keys whose type and unit do not say how they turn.
const SPECIAL: &[(&str, Kind, Dimension)] = &[
    ("domain.low", Kind::Point, LENGTH),
    ("domain.high", Kind::Point, LENGTH),
    ("domain.periodic", Kind::Axes, NONE),
    ("body.position", Kind::Point, LENGTH),
    ("body.quaternion", Kind::Orientation, NONE),
    ("body.spin", Kind::Axial, [0, 0, -1]),
    ("clump.spheres", Kind::Spheres, LENGTH),
    ("clump.moments", Kind::Moments, NONE),
    ("fill.shape", Kind::Shape, LENGTH),
    ("insert.shape", Kind::Shape, LENGTH),
    ("remove.shape", Kind::Shape, LENGTH),
    ("fill.sizes", Kind::Number, NONE),
    ("insert.sizes", Kind::Number, NONE),
    ("wall.plane", Kind::Plane, LENGTH),
    ("wall.box", Kind::Corners, LENGTH),
    ("wall.faces", Kind::Faces, NONE),
    ("wall.solid", Kind::Shape, LENGTH),
    ("outlet.plane", Kind::Plane, LENGTH),
    ("inlet.plane", Kind::Plane, LENGTH),
];

static MEANINGS: LazyLock<BTreeMap<String, Meaning>> = LazyLock::new(|| {
    let mut all = BTreeMap::new();
    for (path, row) in rows() {
        let kind = if row.kind == "3 numbers" { Kind::Vector } else { Kind::Number };
        let path = path.replace("domain.strain.x", "domain.strain");
        all.insert(path, Meaning { dimension: dimension(row.unit), kind });
    }
    for (path, kind, dimension) in SPECIAL {
        all.insert((*path).to_owned(), Meaning { dimension: *dimension, kind: *kind });
    }
    all
});

/// What the value at a dotted path without indices is.
pub fn meaning(path: &str) -> Meaning {
    let last = path.rsplit('.').next().unwrap_or(path);
    // An axis stands in many inline tables.
    match last {
        "about" => Meaning { dimension: NONE, kind: Kind::Axial },
        "through" => Meaning { dimension: LENGTH, kind: Kind::Point },
        "rpm" => Meaning { dimension: [0, 0, -1], kind: Kind::Number },
        _ => {
            // What `domain.strain` says of x holds for every axis.
            let plain = ["x", "y", "z"]
                .iter()
                .fold(path.to_owned(), |path, axis| path.replace(&format!("strain.{axis}"), "strain"));
            MEANINGS.get(&plain).copied().unwrap_or(Meaning { dimension: NONE, kind: Kind::Number })
        }
    }
}

/// What the three columns that begin with this one are, or this single column.
pub fn column(name: &str) -> Meaning {
    let (kind, dimension) = match name {
        "x" => (Kind::Point, LENGTH),
        "vx" => (Kind::Vector, [1, 0, -1]),
        "wx" => (Kind::Axial, [0, 0, -1]),
        "fx" => (Kind::Vector, [1, 1, -2]),
        "nx" => (Kind::Vector, NONE),
        "mx_i" | "mx_j" => (Kind::Axial, [2, 1, -2]),
        "qw" => (Kind::Orientation, NONE),
        "radius" | "overlap" | "diameter" => (Kind::Number, LENGTH),
        "work" | "energy" => (Kind::Number, [2, 1, -2]),
        "mass" => (Kind::Number, [0, 1, 0]),
        "t" | "time" | "broken_at" => (Kind::Number, [0, 0, 1]),
        "tension" | "shear" | "tensile_strength" | "shear_strength" | "stress" => (Kind::Number, [-1, 1, -2]),
        "force" => (Kind::Number, [1, 1, -2]),
        _ => (Kind::Number, NONE),
    };
    Meaning { dimension, kind }
}

/// Columns that a value of this kind takes, from the name of its first one.
pub fn width(meaning: Meaning) -> usize {
    match meaning.kind {
        Kind::Orientation => 4,
        Kind::Vector | Kind::Axial | Kind::Point => 3,
        _ => 1,
    }
}

#[cfg(test)]
mod tests {
    use super::{dimension, meaning};

    /// Every unit of the page is known, and a few that could be mistaken are right.
    #[test]
    fn units_have_dimensions() {
        assert_eq!(dimension("N s/m"), [0, 1, -1]);
        assert_eq!(dimension("J/m²"), [0, 1, -2]);
        assert_eq!(dimension("Pa·s"), [-1, 1, -1]);
        assert_eq!(meaning("contact.stiffness").dimension, [0, 1, -2]);
        assert_eq!(meaning("domain.strain.y.rate").dimension, [0, 0, -1]);
        assert_eq!(meaning("wall.motion.ramp").dimension, [0, 0, 1]);
    }
}

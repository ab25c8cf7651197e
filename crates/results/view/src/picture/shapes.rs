//! The rods of bonds, cracks and arrows.

use super::rod::{Rod, RodShape};
use crate::appearance::colour::{Rgb, fraction};
use crate::appearance::scale::{Range, round_below};
use crate::things::extras::{ALONG, ARROW, Arrows, BOND, CRACK, HEAD};
use geom::Vec3;
use record::column::{BROKEN, POSITION, RADIUS};
use stream::{Table, Values};

/// Colour of bonds.
pub(super) const WHOLE: [f32; 3] = [0.42, 0.46, 0.52];
/// Colour of cracks.
pub(super) const BREAK: [f32; 3] = [0.86, 0.16, 0.12];
/// Lengths of arrows that are kept of a moment, at most.
const SAMPLE: usize = 20_000;

/// A start and a vector for each row, with a radius [m].
pub(super) fn rows(table: &Table) -> Vec<(Vec3, Vec3, f64)> {
    let column = |name| table.get(name).map(Values::to_f64).unwrap_or_default();
    let [x, y, z] = POSITION.map(column);
    let [dx, dy, dz] = ALONG.map(column);
    let row = |(k, r): (usize, &f64)| (Vec3::new(x[k], y[k], z[k]), Vec3::new(dx[k], dy[k], dz[k]), *r);
    column(RADIUS).iter().enumerate().map(row).collect()
}

/// Bonds are thin beams, cracks are discs across them; and how many bonds are whole, and broken.
pub(super) fn bonds(table: &Table) -> (Vec<Rod>, [usize; 2]) {
    let broken = table.get(BROKEN).map(Values::to_f64).unwrap_or_default();
    let rod = |(k, (middle, half, radius)): (usize, (Vec3, Vec3, f64))| match broken.get(k) {
        Some(2.0) => None,
        Some(1.0) => {
            let (ends, radii) = ([middle, middle + half], [CRACK * radius; 2]);
            Some(Rod { ends, radii, shape: RodShape::Disc, colour: BREAK })
        }
        _ => {
            let (ends, radii) = ([middle - half, middle + half], [BOND * radius; 2]);
            Some(Rod { ends, radii, shape: RodShape::Cone, colour: WHOLE })
        }
    };
    let count = broken.iter().filter(|b| **b != 0.0).count();
    let rods = rows(table).into_iter().enumerate().filter_map(rod).collect();
    (rods, [broken.len() - count, count])
}

/// The ends of all rods [m].
pub(super) fn ends(table: &Table) -> Vec<Vec3> {
    rows(table).into_iter().flat_map(|(middle, half, _)| [middle - half, middle + half]).collect()
}

/// Thin lines of one colour.
pub(super) fn outlines(table: &Table, colour: Rgb) -> Vec<Rod> {
    let rod = |(middle, half, radius): (Vec3, Vec3, f64)| Rod {
        ends: [middle - half, middle + half],
        radii: [radius; 2],
        shape: RodShape::Cone,
        colour: fraction(colour),
    };
    rows(table).into_iter().map(rod).collect()
}

/// What was seen of all arrows that are to be drawn.
#[derive(Clone, Default)]
pub(super) struct ArrowSurvey {
    of: Option<Arrows>,
    lengths: Vec<f64>,
    radius: f64,
    count: usize,
}

/// What the length of an arrow means.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ArrowKey {
    pub of: Arrows,
    /// Length over value [m per unit].
    pub scale: f64,
    /// A round value, for the legend.
    pub example: f64,
    /// Mean radius of the grains [m].
    pub radius: f64,
}

impl ArrowSurvey {
    /// Takes in a moment.
    pub fn add(&mut self, of: Arrows, table: &Table) {
        self.of = Some(of);
        let rows = rows(table);
        let step = rows.len().div_ceil(SAMPLE).max(1);
        for (_, vector, radius) in rows.into_iter().step_by(step) {
            self.lengths.push(vector.norm());
            self.radius += radius;
            self.count += 1;
        }
    }

    /// 98 % of the arrows are shorter than a few radii.
    pub fn key(&self) -> Option<ArrowKey> {
        let radius = self.radius / self.count.max(1) as f64;
        Some(arrow_key(self.of?, Range::of_most(&self.lengths).hi, radius))
    }
}

/// The scale of arrows, most of which have no larger value than `most`, of grains with a mean `radius` [m].
pub(crate) fn arrow_key(of: Arrows, most: f64, radius: f64) -> ArrowKey {
    let most = if most > 0.0 && most.is_finite() { most } else { 1.0 };
    ArrowKey { of, scale: ARROW * radius / most, example: round_below(most), radius }
}

/// A shaft and a head for each arrow that is long enough to be seen.
pub(super) fn arrows(table: &Table, key: &ArrowKey, colour: [f32; 3]) -> Vec<Rod> {
    let mut rods = Vec::new();
    for (start, vector, _) in rows(table) {
        rods.extend(arrow(start, vector * key.scale, key.radius, colour).into_iter().flatten());
    }
    rods
}

fn arrow(start: Vec3, along: Vec3, radius: f64, colour: [f32; 3]) -> Option<[Rod; 2]> {
    let length = along.norm();
    let head = (HEAD[1] * radius).min(0.6 * length);
    if length < 0.1 * radius {
        return None;
    }
    let (tip, neck) = (start + along, start + along * (1.0 - head / length));
    let thick = head / HEAD[1];
    let rod = |ends, radii| Rod { ends, radii, shape: RodShape::Cone, colour };
    Some([rod([start, neck], [0.3 * HEAD[0] * thick; 2]), rod([neck, tip], [HEAD[0] * thick, 0.0])])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arrow_is_as_long_as_its_value_and_ends_in_a_point() {
        let key = arrow_key(Arrows::Velocity, 2.4, 0.01);
        assert_eq!((key.example, key.scale), (2.0, ARROW * 0.01 / 2.4));
        let [shaft, head] =
            arrow(Vec3::zeros(), Vec3::x() * 2.4 * key.scale, 0.01, [0.0; 3]).expect("long enough");
        assert_eq!(head.ends[1], Vec3::x() * (ARROW * 0.01));
        assert!(head.radii[1] == 0.0 && head.radii[0] > shaft.radii[0] && shaft.ends[1] == head.ends[0]);
        assert!(arrow(Vec3::zeros(), Vec3::zeros(), 0.01, [0.0; 3]).is_none());
    }
}

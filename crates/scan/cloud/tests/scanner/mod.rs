//! A scan whose every point has a label: a scanner looks at a floor with a swell, a box, a post, a wall and a bush, and its beam has a width, so that
//! it mixes what lies beside an edge.

use super::random::Random;
use geom::Vec3;

/// Where the scanner stands [m].
pub const EYE: Vec3 = Vec3::new(0.0, 0.0, 1.8);
/// Angle between two beams [rad].
pub const STEP: f64 = 0.004;
/// Radius of a beam [rad].
const BEAM: f64 = 0.003;
/// Sub-beams of a beam, beside that in its middle.
const SUB: usize = 8;
/// A point that is farther from all that its beam has met is mixed [m].
const APART: f64 = 0.05;

/// What a point is of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Label {
    Floor,
    Box,
    Post,
    Wall,
    Bush,
    /// In the air beside an edge.
    Mixed,
}

fn floor(x: f64, y: f64) -> f64 {
    0.12 * (0.9 * x).sin() * (0.7 * y).cos()
}

/// Range of the first thing that a line of sight meets [m], and what it is.
pub fn hit(to: &Vec3) -> Option<(f64, Label)> {
    let mut best: Option<(f64, Label)> = None;
    let mut meet = |range: f64, label: Label| {
        if range > 0.1 && best.is_none_or(|(r, _)| range < r) {
            best = Some((range, label));
        }
    };
    // The floor: from above it to below it.
    let above = |range: f64| {
        let p = EYE + to * range;
        p.z - floor(p.x, p.y)
    };
    if to.z < -0.05 {
        let (mut near, mut far) = (0.0, 2.2 / -to.z);
        for _ in 0..40 {
            let middle = 0.5 * (near + far);
            if above(middle) > 0.0 { near = middle } else { far = middle }
        }
        meet(near, Label::Floor);
    }
    // A box, by its slabs.
    let (low, high) = (Vec3::new(1.8, -0.6, -1.0), Vec3::new(2.8, 0.5, 0.9));
    let [mut from, mut until] = [0.0f64, f64::INFINITY];
    for a in 0..3 {
        let ends = [(low[a] - EYE[a]) / to[a], (high[a] - EYE[a]) / to[a]];
        from = from.max(ends[0].min(ends[1]));
        until = until.min(ends[0].max(ends[1]));
    }
    if from < until {
        meet(from, Label::Box);
    }
    // A post.
    let (dx, dy) = (EYE.x - 1.4, EYE.y - 1.5);
    let (a, b, c) = (to.x * to.x + to.y * to.y, dx * to.x + dy * to.y, dx * dx + dy * dy - 0.0225);
    if b * b > a * c {
        let range = (-b - (b * b - a * c).sqrt()) / a;
        if (EYE + to * range).z < 1.5 {
            meet(range, Label::Post);
        }
    }
    // A wall behind all.
    let range = (4.0 - EYE.x) / to.x;
    if range > 0.0 && (EYE + to * range).z < 2.5 {
        meet(range, Label::Wall);
    }
    best
}

/// The scan, with its labels.
pub fn scan() -> (Vec<Vec3>, Vec<Label>) {
    let mut random = Random(7);
    let (mut points, mut labels) = (Vec::new(), Vec::new());
    let direction = |azimuth: f64, height: f64| {
        Vec3::new(azimuth.cos() * height.cos(), azimuth.sin() * height.cos(), height.sin())
    };
    let count = |span: f64| (span / STEP) as usize;
    for i in 0..count(2.0) {
        for j in 0..count(1.5) {
            let (azimuth, height) = (-0.8 + STEP * i as f64, -1.2 + STEP * j as f64);
            let mut met = Vec::new();
            for k in 0..=SUB {
                let turn = std::f64::consts::TAU * k as f64 / SUB as f64;
                let off = if k == SUB { 0.0 } else { BEAM * (0.5 + 0.5 * (k % 2) as f64) };
                met.extend(hit(&direction(azimuth + off * turn.cos(), height + off * turn.sin())));
            }
            let Some(&(_, label)) = met.last() else { continue };
            let ranges = || met.iter().map(|(range, _)| *range);
            let mean = ranges().sum::<f64>() / met.len() as f64;
            let off = ranges().map(|range| (range - mean).abs()).fold(f64::INFINITY, f64::min);
            points.push(EYE + direction(azimuth, height) * (mean + 0.001 * random.normal()));
            labels.push(if off > APART { Label::Mixed } else { label });
        }
    }
    for _ in 0..4000 {
        let p = Vec3::new(random.next(), random.next(), random.next());
        if (p - Vec3::repeat(0.5)).norm() < 0.5 {
            points.push(Vec3::new(2.9, 1.4, 0.3) + 0.6 * p);
            labels.push(Label::Bush);
        }
    }
    (points, labels)
}

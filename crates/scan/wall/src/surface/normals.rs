//! Turns the normals to the flow side.
//!
//! Neighbours take their side from each other, most alike normals first (the spanning tree of least 1 − |nᵢ·nⱼ|; Hoppe et al. 1992,
//! doi:10.1145/133994.134011), so that a side goes around a sharp edge where the surface bends least, and the walls of a half pipe that
//! lean past the vertical still face inwards. A piece that hangs together starts from the point whose normal agrees best with the
//! direction of the flow side, or from the one nearest to a position in the flow: its own plane decides on which side that is. Where a direction is
//! given, all of the piece decides, most where it lies squarely to it: a single point may be one of a rim.

use geom::Vec3;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Flow<'a> {
    /// In this direction from the surface.
    Towards(Vec3),
    /// Here [m], seen from every point nearest to it.
    At(Vec3),
    /// On the side that is seen from these viewpoints [m]: a piece begins where one of them looks at it most squarely, since a rim is seen from aside.
    SeenFrom(&'a [Vec3]),
}

impl Flow<'_> {
    /// How well a point is fit to begin with: more is better.
    fn fitness(&self, point: &Vec3, normal: &Vec3) -> f64 {
        match self {
            Flow::Towards(facing) => normal.dot(facing).abs(),
            Flow::At(position) => -(position - point).norm(),
            Flow::SeenFrom(_) => normal.dot(&self.seen_from(point, normal)).abs(),
        }
    }

    fn seen_from(&self, point: &Vec3, normal: &Vec3) -> Vec3 {
        match self {
            Flow::Towards(facing) => *facing,
            Flow::At(position) => position - point,
            Flow::SeenFrom(eyes) => {
                let sights = eyes.iter().filter_map(|eye| (eye - point).try_normalize(0.0));
                let squarely = |sight: &Vec3| normal.dot(sight).abs();
                sights.max_by(|a, b| squarely(a).total_cmp(&squarely(b))).unwrap_or_else(Vec3::zeros)
            }
        }
    }
}

/// A step of the tree: the most alike first, then the lowest indices.
struct Step {
    alike: f64,
    to: Reverse<u32>,
    from: Reverse<u32>,
}

impl PartialEq for Step {
    fn eq(&self, other: &Step) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Step {}

impl PartialOrd for Step {
    fn partial_cmp(&self, other: &Step) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Step {
    fn cmp(&self, other: &Step) -> std::cmp::Ordering {
        self.alike.total_cmp(&other.alike).then(self.to.cmp(&other.to)).then(self.from.cmp(&other.from))
    }
}

/// Normals of points [m] turned to the side of the flow.
pub fn oriented(points: &[Vec3], normals: &[Vec3], pairs: &[(u32, u32)], flow: Flow<'_>) -> Vec<Vec3> {
    let mut links = vec![Vec::new(); normals.len()];
    for &(i, j) in pairs {
        links[i as usize].push(j);
        links[j as usize].push(i);
    }
    let mut turned = normals.to_vec();
    let mut done = vec![false; normals.len()];
    let mut order: Vec<u32> = (0..normals.len() as u32).collect();
    let fitness = |i: u32| flow.fitness(&points[i as usize], &normals[i as usize]);
    order.sort_by(|&a, &b| fitness(b).total_cmp(&fitness(a)).then(a.cmp(&b)));
    let alike = |i: u32, j: u32| normals[i as usize].dot(&normals[j as usize]).abs();
    for start in order {
        if done[start as usize] {
            continue;
        }
        turn(&mut turned[start as usize], &flow.seen_from(&points[start as usize], &normals[start as usize]));
        let mut piece = Vec::new();
        let mut steps = BinaryHeap::from([Step { alike: 1.0, to: Reverse(start), from: Reverse(start) }]);
        while let Some(Step { to: Reverse(i), from: Reverse(before), .. }) = steps.pop() {
            if std::mem::replace(&mut done[i as usize], true) {
                continue;
            }
            piece.push(i);
            let like = turned[before as usize];
            turn(&mut turned[i as usize], &like);
            for &j in links[i as usize].iter().filter(|&&j| !done[j as usize]) {
                steps.push(Step { alike: alike(i, j), to: Reverse(j), from: Reverse(i) });
            }
        }
        if let Flow::Towards(facing) = flow
            && piece.iter().map(|&i| turned[i as usize].dot(&facing).powi(3)).sum::<f64>() < 0.0
        {
            piece.iter().for_each(|&i| turned[i as usize] = -turned[i as usize]);
        }
    }
    turned
}

/// A point on a line has no normal of its own and takes its neighbour's.
fn turn(normal: &mut Vec3, like: &Vec3) {
    if normal.norm_squared() == 0.0 {
        *normal = like.try_normalize(0.0).unwrap_or_else(Vec3::z);
    } else if normal.dot(like) < 0.0 {
        *normal = -*normal;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_side_goes_around_a_pipe_seen_from_a_position_in_it() {
        let points: Vec<Vec3> = (0..60)
            .map(|i| Vec3::new(0.0, (f64::from(i) * 0.1047).cos(), (f64::from(i) * 0.1047).sin()))
            .collect();
        let pairs: Vec<(u32, u32)> = (0..60).map(|i| (i.min((i + 1) % 60), i.max((i + 1) % 60))).collect();
        let shaken: Vec<Vec3> = (0..60).map(|i| if i % 3 == 0 { -points[i] } else { points[i] }).collect();
        let inwards = oriented(&points, &shaken, &pairs, Flow::At(Vec3::new(0.0, 0.3, 0.1)));
        assert!(points.iter().zip(&inwards).all(|(p, n)| p.dot(n) < -0.99));
        let outwards = oriented(&points, &shaken, &pairs, Flow::At(Vec3::new(0.0, 3.0, 0.1)));
        assert!(points.iter().zip(&outwards).all(|(p, n)| p.dot(n) > 0.99));
    }

    #[test]
    fn the_side_takes_the_smooth_way_around_an_edge() {
        // An edge whose last step turns by more than a right angle; over the rounded corner it does not.
        let turns: [f64; 5] = [0.0, 60.0, 120.0, 100.0, 40.0];
        let normals: Vec<Vec3> =
            turns.iter().map(|t| Vec3::new(t.to_radians().cos(), t.to_radians().sin(), 0.0)).collect();
        let pairs = [(0, 1), (0, 2), (1, 2)];
        let shaken = [normals[0], -normals[1], -normals[2]];
        let points = [Vec3::zeros(), Vec3::x(), Vec3::x() * 2.0];
        let turned = oriented(&points, &shaken, &pairs, Flow::Towards(Vec3::x()));
        assert!((0..3).all(|i| turned[i].dot(&normals[i]) > 0.99), "{turned:?}");
    }
}

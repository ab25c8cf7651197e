//! The points that stand out farthest, each way: what a camera must see to see everything.

use crate::spheres::Spheres;
use geom::Vec3;

/// Spheres of a layer that are looked at, at most: their outline hardly depends on more.
const SAMPLE: usize = 8192;

/// Share of grains left out at each end of each direction: strays that fell off must not shrink the rest to a dot.
const STRAYS: f64 = 0.01;

/// They are kept where leaving them out would gain less than this share of the width [–].
const NEAR: f64 = 0.12;

/// Places that stand out.
#[derive(Clone, Default)]
pub(crate) struct Outline {
    /// The farthest point in each direction [m], with how far.
    ends: Vec<(f64, Vec3)>,
}

impl Outline {
    /// Takes in spheres; without their strays when they are `loose`.
    pub fn add_spheres(&mut self, spheres: &Spheres, loose: bool) {
        let step = if loose { spheres.len().div_ceil(SAMPLE).max(1) } else { 1 };
        let balls: Vec<(Vec3, f64)> =
            (0..spheres.len()).step_by(step).map(|i| (spheres.at(i), spheres.radius[i])).collect();
        for (n, direction) in directions().enumerate() {
            let reach = balls.iter().map(|(p, r)| p.dot(&direction) + r).enumerate();
            if let Some(i) = farthest(reach.map(|(i, far)| (far, i)).collect(), loose) {
                let point = balls[i].0 + direction * balls[i].1;
                self.take(n, point.dot(&direction), point);
            }
        }
    }

    /// Takes in points.
    pub fn add(&mut self, points: &[Vec3]) {
        for (n, direction) in directions().enumerate() {
            for point in points {
                self.take(n, point.dot(&direction), *point);
            }
        }
    }

    fn take(&mut self, direction: usize, far: f64, point: Vec3) {
        match self.ends.get_mut(direction) {
            Some(end) if end.0 < far => *end = (far, point),
            Some(_) => {}
            None => self.ends.push((far, point)),
        }
    }

    /// The points [m].
    pub fn points(&self) -> Vec<Vec3> {
        let mut points: Vec<Vec3> = self.ends.iter().map(|(_, point)| *point).collect();
        points.dedup();
        points
    }
}

/// Which of (how far, which) is the farthest, strays left out when they are `loose` and far off.
fn farthest(mut reach: Vec<(f64, usize)>, loose: bool) -> Option<usize> {
    let order = |a: &(f64, usize), b: &(f64, usize)| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1));
    let first = *reach.iter().min_by(|a, b| order(a, b))?;
    let strays = (STRAYS * (reach.len() - 1) as f64).round() as usize;
    let (last, strays) = (reach.len() - 1 - strays, if loose { strays } else { 0 });
    let most = *reach.select_nth_unstable_by(strays, order).1;
    let least = *reach.select_nth_unstable_by(last, order).1;
    Some(if first.0 - most.0 <= NEAR * (most.0 - least.0) { first.1 } else { most.1 })
}

/// 98 directions: those of a lattice five wide, each once.
fn directions() -> impl Iterator<Item = Vec3> {
    let at = |n: i32| [n % 5 - 2, n / 5 % 5 - 2, n / 25 - 2];
    let once = |p: &[i32; 3]| p.iter().any(|c| c % 2 != 0);
    (0..125).map(at).filter(once).map(|p| Vec3::from(p.map(f64::from)).normalize())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ball_of_spheres_is_outlined_without_its_stray() {
        let point = |i: usize| {
            let (a, z) = (2.4 * i as f64, (i as f64 + 0.5) / 500.0 - 1.0);
            let r = (1.0 - z * z).sqrt();
            Vec3::new(r * a.cos(), r * a.sin(), z)
        };
        let mut all: Vec<Vec3> = (0..1000).map(point).collect();
        all.push(Vec3::new(1e4, 0.0, 0.0));
        let centre = std::array::from_fn(|k| all.iter().map(|p| p[k]).collect());
        let spheres = Spheres { centre, radius: vec![0.0; all.len()], sized: true };
        let outlined = |loose| {
            let mut outline = Outline::default();
            outline.add_spheres(&spheres, loose);
            outline.points().iter().map(|p| p.norm()).fold(0.0, f64::max)
        };
        assert!(outlined(false) > 1e3 && (outlined(true) - 1.0).abs() < 1e-9);
        assert_eq!(directions().count(), 98);
    }
}

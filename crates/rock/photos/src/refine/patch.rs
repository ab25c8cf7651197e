//! How well photographs agree on a small square of the surface.

use super::Shot;
use crate::field::Field;
use crate::photograph::Photograph;
use geom::Vec3;

/// Samples of a patch along each side, and their distance in pixels of the crop.
const SIDE: i32 = 4;
const SPACING: f64 = 1.25;
/// Samples of a patch.
const SAMPLES: usize = ((2 * SIDE + 1) * (2 * SIDE + 1)) as usize;
/// Least cosine between the normal and the direction to the camera.
const FRONTAL: f64 = 0.45;
/// Angles between the photographs that are compared [rad].
const BESIDE: [f64; 2] = [0.12, 0.8];
/// Photographs that are compared with the most frontal one, at most.
const OTHERS: usize = 4;
/// Least standard deviation of the light of a patch over its mean: less is no speckle.
const SPECKLE: f64 = 0.03;

/// Light around the stone, at the resolution of its distance field.
#[derive(Debug, Clone)]
pub struct Crop {
    width: usize,
    height: usize,
    origin: [f64; 2],
    step: f64,
    light: Vec<f32>,
}

impl Crop {
    /// Of a photograph: means of the pixels of each sample of the field.
    pub fn new(photograph: &Photograph, field: &Field) -> Crop {
        let ([width, height], origin, step) = field.grid();
        let k = step as i64;
        let first = [0, 1].map(|a| (origin[a] - (step - 1.0) / 2.0).round() as i64);
        let within = |p: i64, size: usize| p.clamp(0, size as i64 - 1) as usize;
        let mean = |n: usize| {
            let (x, y) = (first[0] + (n % width) as i64 * k, first[1] + (n / width) as i64 * k);
            let mut sum = 0.0;
            for v in y..y + k {
                let row = within(v, photograph.height) * photograph.width;
                sum += (x..x + k).map(|u| photograph.light[row + within(u, photograph.width)]).sum::<f32>();
            }
            sum / (k * k) as f32
        };
        Crop { width, height, origin, step, light: (0..width * height).map(mean).collect() }
    }

    fn at(&self, [x, y]: [f64; 2]) -> Option<f64> {
        let (u, v) = ((x - self.origin[0]) / self.step, (y - self.origin[1]) / self.step);
        if !(u >= 0.0 && v >= 0.0 && u < self.width as f64 - 1.0 && v < self.height as f64 - 1.0) {
            return None;
        }
        let (i, j) = (u as usize, v as usize);
        let (s, t) = (u - i as f64, v - j as f64);
        let k = j * self.width + i;
        let value = |k: usize| f64::from(self.light[k]);
        let row = |k: usize| value(k) + s * (value(k + 1) - value(k));
        Some(row(k) + t * (row(k + self.width) - row(k)))
    }
}

/// The most frontal photograph, and some beside it; `None` when there are no two.
pub(super) fn chosen<'a>(place: &Vec3, normal: &Vec3, shots: &[&'a Shot]) -> Option<Vec<&'a Shot>> {
    let to = |s: &Shot| (s.view.camera.eye() - place).normalize();
    let mut frontal: Vec<(f64, &Shot)> =
        shots.iter().map(|s| (normal.dot(&to(s)), *s)).filter(|s| s.0 > FRONTAL).collect();
    frontal.sort_by(|a, b| b.0.total_cmp(&a.0));
    let first = frontal.first()?.1;
    let main = to(first);
    let beside = frontal.iter().skip(1).filter(|s| {
        let angle = main.dot(&to(s.1)).clamp(-1.0, 1.0).acos();
        (BESIDE[0]..BESIDE[1]).contains(&angle)
    });
    let all: Vec<&Shot> = std::iter::once(first).chain(beside.map(|s| s.1).take(OTHERS)).collect();
    (all.len() > 1).then_some(all)
}

/// Mean correlation of the first photograph with the others.
pub(super) fn correlation(place: &Vec3, normal: &Vec3, shots: &[&Shot]) -> Option<f64> {
    let first = shots.first()?;
    let across = normal.cross(&if normal.x.abs() < 0.6 { Vec3::x() } else { Vec3::y() }).normalize();
    let up = normal.cross(&across);
    let (_, depth) = first.view.camera.project(place);
    let pixel = SPACING * first.crop.step * depth / first.view.camera.mean_focal();
    let patch = |shot: &Shot| -> Option<[f64; SAMPLES]> {
        let mut values = [0.0; SAMPLES];
        let mut n = 0;
        for v in -SIDE..=SIDE {
            for u in -SIDE..=SIDE {
                let p = place + across * (f64::from(u) * pixel) + up * (f64::from(v) * pixel);
                values[n] = shot.crop.at(shot.view.camera.project(&p).0)?;
                n += 1;
            }
        }
        normalized(values)
    };
    let main = patch(first)?;
    let with = |shot: &&Shot| patch(shot).map(|p| p.iter().zip(&main).map(|(a, b)| a * b).sum::<f64>());
    let mut all: Vec<f64> = shots[1..].iter().filter_map(with).collect();
    // Half of them: others may be hidden.
    all.sort_by(|a, b| b.total_cmp(a));
    let count = all.len().div_ceil(2);
    (count > 0).then(|| all[..count].iter().sum::<f64>() / count as f64)
}

/// Without mean, and of length 1; `None` without speckle.
fn normalized(mut values: [f64; SAMPLES]) -> Option<[f64; SAMPLES]> {
    let n = SAMPLES as f64;
    let mean = values.iter().sum::<f64>() / n;
    values.iter_mut().for_each(|v| *v -= mean);
    let length = values.iter().map(|v| v * v).sum::<f64>().sqrt();
    if !(length > SPECKLE * mean * n.sqrt()) {
        return None;
    }
    values.iter_mut().for_each(|v| *v /= length);
    Some(values)
}

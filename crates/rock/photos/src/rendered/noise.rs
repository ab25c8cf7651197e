//! Speckle, blur and noise.

use geom::Vec3;

/// Share of the lattice's cells with a speckle.
const SHARE: u64 = 45;

/// Whether a place, in units of the speckle's extent, is on a speckle: balls in some cells of a lattice.
pub(super) fn speckle(place: &Vec3) -> bool {
    let cell = place.map(f64::floor);
    (0..27).any(|k: i32| {
        let c = cell + Vec3::new(f64::from(k % 3 - 1), f64::from(k / 3 % 3 - 1), f64::from(k / 9 - 1));
        let h = hash(&c);
        let at = |shift: u32| (h >> shift & 0xffff) as f64 / 65536.0;
        let centre = c + Vec3::new(at(0), at(16), at(32));
        (h >> 48) % 100 < SHARE && (place - centre).norm() < 0.25 + 0.3 * at(24)
    })
}

/// A number that mixes the three numbers of a cell (the finalizer of SplitMix64: Steele, Lea & Flood 2014, doi:10.1145/2660193.2660195).
fn hash(c: &Vec3) -> u64 {
    let mut h = 0u64;
    for v in c.iter() {
        h = (h ^ (*v as i64) as u64).wrapping_add(0x9e37_79b9_7f4a_7c15);
        h = (h ^ (h >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        h = (h ^ (h >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        h ^= h >> 31;
    }
    h
}

/// Blurs by a Gaussian of this standard deviation [px]: along rows, then along columns.
pub(super) fn blur(light: &mut [f32], width: usize, sigma: f64) {
    if !(sigma > 0.0) {
        return;
    }
    let reach = (3.0 * sigma).ceil() as i64;
    let weight: Vec<f64> =
        (-reach..=reach).map(|k| libm::exp(-((k * k) as f64) / (2.0 * sigma * sigma))).collect();
    let sum: f64 = weight.iter().sum();
    let height = light.len() / width;
    for (count, length, step, next) in [(height, width, 1, width), (width, height, width, 1)] {
        for line in 0..count {
            let row: Vec<f32> = (0..length).map(|k| light[line * next + k * step]).collect();
            for k in 0..length {
                let at = |j: i64| f64::from(row[(k as i64 + j).clamp(0, length as i64 - 1) as usize]);
                let value: f64 = (-reach..=reach).zip(&weight).map(|(j, w)| w * at(j)).sum();
                light[line * next + k * step] = (value / sum) as f32;
            }
        }
    }
}

/// Adds noise of this standard deviation: the sum of twelve even numbers.
pub(super) fn add(light: &mut [f32], deviation: f64, seed: u64) {
    if !(deviation > 0.0) {
        return;
    }
    for (k, light) in light.iter_mut().enumerate() {
        let mut h = hash(&Vec3::new(k as f64, seed as f64, 1.0));
        let mut sum = 0.0;
        for n in 0..3 {
            h = hash(&Vec3::new((h >> 20) as f64, f64::from(n), 2.0));
            sum += (0..4).map(|s| (h >> (16 * s) & 0xffff) as f64 / 65536.0).sum::<f64>();
        }
        *light += (deviation * (sum - 6.0)) as f32;
    }
}

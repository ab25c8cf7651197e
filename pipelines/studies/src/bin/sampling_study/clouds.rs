//! The clouds that are sampled.

use geom::Vec3;
use std::path::Path;

/// Name, file among the samples, and spacing [m].
pub const SCANS: [(&str, &str, f64); 2] = [
    ("chute (synthetic, as a scanner sees it)", "chute/chute.ply", 0.012),
    ("river boulders (terrestrial scan)", "boulders/boulders.ply", 0.03),
];

/// Uniform numbers in [0, 1) (splitmix64, Steele et al. 2014).
fn uniform(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ (x >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// A gently bent sheet over 1 m².
pub fn sheet(count: usize) -> Vec<Vec3> {
    let mut next = uniform(2);
    let mut place = || (next(), next());
    (0..count).map(|_| place()).map(|(x, y)| Vec3::new(x, y, 0.05 * (4.0 * x).sin())).collect()
}

/// Both sides of a plate [m] of 1 m², noise of σ [m] along each axis.
pub fn plate(count: usize, thickness: f64, noise: f64) -> Vec<Vec3> {
    let mut next = uniform(11);
    (0..count)
        .map(|_| {
            let p = Vec3::new(next(), next(), if next() < 0.5 { 0.0 } else { thickness });
            let mut off = || noise * (next() + next() + next() + next() - 2.0) * 3f64.sqrt();
            p + Vec3::new(off(), off(), off())
        })
        .collect()
}

/// A scan of the samples.
pub fn read(file: &str) -> Result<cloud::Cloud, String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../sample-data").join(file);
    let open = std::fs::File::open(&path).map_err(|why| format!("{}: {why}", path.display()))?;
    cloud::read(open).map_err(|why| format!("{}: {why}", path.display()))
}

//! Tiles: a pattern made beforehand is laid onto the surface patch by patch.
//!
//! ```text
//! patches      points nearest to the same one of coarse Poisson-disk centres, 10 r apart
//! pattern      each patch is laid flat onto its plane of least squares (distances from its middle kept); over it lies a square
//!              tile of points of even distances that repeats without seam, randomly shifted and rotated
//! chosen       the point of the cloud nearest to each point of the pattern
//! seams        where patches meet, Poisson-disk sampling drops one of two points that are too near, and gaps are filled by Poisson disk
//! ```
//!
//! Least distance r and no gap wider than r hold as for Poisson disk. Tiles of point patterns: Cohen et al. (2003),
//! doi:10.1145/882262.882265; Lagae & Dutré (2005), doi:10.1145/1095878.1095888; Kopf et al. (2006), doi:10.1145/1141911.1141916. Deviation:
//! one tile that meets itself, randomly rotated from patch to patch, instead of a set whose coloured edges fit, since patches of a
//! scanned surface fit no square; the seams are closed afterwards.

use crate::cells::Cells;
use crate::nearest::owners;
use crate::poisson::{chance, poisson};
use crate::torus::Tile;
use geom::{PrincipalAxes, Vec3};
use rayon::prelude::*;

/// Distance of the patches' centres in spacings: some 70 points each.
const PATCH: f64 = 10.0;
/// A point stands for one of the pattern when it is no farther from it, in spacings.
const NEAR: f64 = 0.5;

/// Indices of the kept points, ascending; `forced` ones are all kept. `cells` holds the cloud for searches up to `spacing` [m].
pub(crate) fn tiled(
    points: &[Vec3],
    cells: &Cells,
    spacing: f64,
    seed: u64,
    forced: Option<&[bool]>,
) -> Vec<u32> {
    let mut first = vec![false; points.len()];
    patterned(points, spacing, seed).into_iter().for_each(|i| first[i as usize] = true);
    let is_forced = |i: u32| forced.is_some_and(|f| f[i as usize]);
    let all = 0..points.len() as u32;
    let some: Vec<u32> = all.filter(|&i| first[i as usize] || is_forced(i)).collect();
    let crowd: Vec<Vec3> = some.iter().map(|&i| points[i as usize]).collect();
    let must: Vec<bool> = some.iter().map(|&i| is_forced(i)).collect();
    let apart = poisson(&Cells::new(&crowd, spacing), spacing, seed, Some(&must));
    let mut keep = vec![false; points.len()];
    apart.into_iter().for_each(|k| keep[some[k as usize] as usize] = true);
    poisson(cells, spacing, seed, Some(&keep))
}

/// The points nearest to those of the pattern, over all patches.
fn patterned(points: &[Vec3], spacing: f64, seed: u64) -> Vec<u32> {
    let wide = PATCH * spacing;
    let centres = poisson(&Cells::new(points, wide), wide, seed, None);
    let owner = owners(points, &centres, wide);
    let mut members: Vec<Vec<u32>> = vec![Vec::new(); centres.len()];
    (0..).zip(&owner).for_each(|(i, &patch)| members[patch as usize].push(i));
    let tile = Tile::new();
    let patch = |(patch, members): (usize, &Vec<u32>)| {
        let random = [1, 2, 3].map(|k| chance(seed.wrapping_add(k), u64::from(centres[patch])));
        laid(points, members, &tile, spacing, random.map(|l| (l >> 11) as f64 / (1u64 << 53) as f64))
    };
    members.par_iter().enumerate().flat_map_iter(patch).collect()
}

/// Of the `members` of a patch, those nearest to the points of the pattern.
fn laid(points: &[Vec3], members: &[u32], tile: &Tile, spacing: f64, random: [f64; 3]) -> Vec<u32> {
    let principal = PrincipalAxes::of(members.iter().map(|&i| &points[i as usize]));
    let (middle, axes) = (principal.middle, principal.in_plane());
    let (sin, cos) = libm::sincos(std::f64::consts::TAU * random[0]);
    let scale = tile.nearest / spacing;
    let place = |p: Vec3| {
        let d = p - middle;
        let [u, v] = [d.dot(&axes[0]), d.dot(&axes[1])];
        let length = (u * u + v * v).sqrt();
        // Laid flat, not foreshortened.
        let stretch = if length > 0.0 { scale * d.norm() / length } else { 0.0 };
        [stretch * (u * cos - v * sin) + random[1], stretch * (u * sin + v * cos) + random[2]]
    };
    let most = (NEAR * tile.nearest).powi(2);
    let near = |&i: &u32| {
        let (of, square) = tile.nearest_to(place(points[i as usize]))?;
        (square <= most).then_some((of, square.to_bits(), i))
    };
    let mut found: Vec<_> = members.iter().filter_map(near).collect();
    found.sort_unstable();
    found.dedup_by_key(|(of, ..)| *of);
    found.into_iter().map(|(.., i)| i).collect()
}

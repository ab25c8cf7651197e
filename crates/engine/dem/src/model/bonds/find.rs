//! Which particles are bonded.

use crate::model::SetupError;
use crate::model::bonds::NewBond;
use crate::model::bonds::kinds::{End, numbers};
use crate::model::quantity::material_names;
use crate::setup::bond::cluster_of;
use crate::setup::{Bond, BondNumbers, Particle, Setup};
use crate::space::search::{Search, pairs};
use geom::Vec3;
use laws::space::cell::Cell;
use nalgebra::UnitQuaternion;

/// A particle that may be bonded.
#[derive(Debug, Clone, Copy)]
pub struct Grain {
    /// Its row.
    pub row: u32,
    /// What a bond is made of.
    pub end: End,
    /// Index of its material.
    pub material: u16,
    /// Its cluster; 0: none.
    pub cluster: u32,
    /// Centre [m].
    pub position: Vec3,
}

/// The particles at t = 0, by id.
pub fn grains(setup: &Setup) -> Vec<Grain> {
    let mut sorted: Vec<_> = setup.particles.iter().collect();
    sorted.sort_unstable_by_key(|p| p.id);
    let grain = |(p, row): (&Particle, u32)| {
        let mass = crate::space::mass(p.radius, setup.materials[p.material as usize].density);
        let end = End { id: p.id, radius: p.radius, mass, turn: UnitQuaternion::identity() };
        Grain {
            row,
            end,
            material: p.material,
            cluster: cluster_of(&setup.clusters, p.id),
            position: p.position,
        }
    };
    sorted.into_iter().zip(0..).map(grain).collect()
}

/// All bonds at t = 0; their ends are positions in the list of particles by id.
///
/// # Errors
/// Two centres at one position; a law for which there is no pair.
pub fn bonded_pairs(setup: &Setup) -> Result<Vec<NewBond>, SetupError> {
    let laws: Vec<&Bond> = setup.bonds.iter().filter(|law| law.at <= 0.0).collect();
    let found = find(&Cell::at_rest(setup.periodic), &laws, &grains(setup), |_| false)?;
    // Where particles come in, those of a rule may be among them.
    match found.used.iter().position(|used| !used).filter(|_| setup.inlets.is_empty()) {
        Some(n) => Err(SetupError::BondJoinsNothing {
            between: material_names(setup, laws[n].between),
            gap: laws[n].gap,
            clusters: laws[n].clusters,
        }),
        None => Ok(found.pairs),
    }
}

/// All bonds at t = 0, by the ids of their particles, the lower first; the section's `share` and `axis` are those of the first.
///
/// # Errors
/// Two centres at one position; a law for which there is no pair.
pub fn bonds_at_start(setup: &Setup) -> Result<Vec<([u32; 2], BondNumbers)>, SetupError> {
    let mut ids: Vec<u32> = setup.particles.iter().map(|p| p.id).collect();
    ids.sort_unstable();
    let of = |bond: NewBond| (bond.ends.map(|row| ids[row as usize]), bond.numbers);
    let mut all: Vec<_> = bonded_pairs(setup)?.into_iter().map(of).collect();
    all.sort_unstable_by_key(|(ids, _)| *ids);
    Ok(all)
}

/// Bonds that laws make.
pub struct Found {
    /// By the ids of their ends.
    pub pairs: Vec<NewBond>,
    /// Which laws made any.
    pub used: Vec<bool>,
}

/// The bonds that laws make between grains, which are sorted by id; none between two rows that are bonded already. The first law that fits makes it.
///
/// # Errors
/// Two centres at one position.
pub fn find(
    cell: &Cell,
    laws: &[&Bond],
    grains: &[Grain],
    is_bonded: impl Fn([u32; 2]) -> bool,
) -> Result<Found, SetupError> {
    let gap = laws.iter().map(|b| b.gap).fold(0.0, f64::max);
    let (mut used, mut pairs) = (vec![false; laws.len()], Vec::new());
    if laws.is_empty() {
        return Ok(Found { pairs, used });
    }
    for [i, j] in near(cell, grains, gap) {
        let (a, b) = (&grains[i as usize], &grains[j as usize]);
        let arm = cell.nearest(a.position - b.position);
        let open = arm.norm() - a.end.radius - b.end.radius;
        // Positions have so many digits.
        let digits = 4.0 * f64::EPSILON * (a.position.amax() + b.position.amax() + arm.norm());
        let (materials, clusters) = ([a.material, b.material], [a.cluster, b.cluster]);
        let joins = |law: &&Bond| law.joins(materials, clusters, open - digits);
        let Some(n) = laws.iter().position(joins) else { continue };
        let rows = [a.row, b.row];
        if is_bonded(rows) {
            continue;
        }
        if arm.norm() <= 0.0 {
            return Err(SetupError::BondOfZeroLength { ids: [a.end.id, b.end.id] });
        }
        used[n] = true;
        pairs.push(NewBond { ends: rows, numbers: numbers(laws[n], [a.end, b.end], &arm) });
    }
    Ok(Found { pairs, used })
}

/// Pairs of positions in the list that may be near enough; each once, in their order.
fn near(cell: &Cell, grains: &[Grain], gap: f64) -> Vec<[u32; 2]> {
    // What lies within rounding of a gap is left to the test of each pair.
    let reach: Vec<f64> = grains.iter().map(|g| (g.end.radius + 0.5 * gap) * (1.0 + 1e-6)).collect();
    let points: Vec<Vec3> = grains.iter().map(|g| g.position).collect();
    let search = Search::new(&points, &reach);
    let mut found = pairs(&search, &search.wide_pairs(), &(0..points.len()));
    let mut images = Vec::new();
    for image in cell.half_of_images() {
        search.image_pairs(image, &cell.shift(&image), 0.0, &mut images);
    }
    found.extend(images.into_iter().map(|image| (image.i, image.j)));
    let row = |k: u32| search.order()[k as usize];
    let both = |(i, j)| [row(i).min(row(j)), row(i).max(row(j))];
    let mut found: Vec<[u32; 2]> = found.into_iter().map(both).collect();
    found.sort_unstable();
    found.dedup();
    found
}

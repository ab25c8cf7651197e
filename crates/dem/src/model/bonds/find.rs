//! Which particles are bonded at the start.

use crate::model::bonds::motions::frequency;
use crate::model::quantity::material_names;
use crate::model::{Beam, BondedPair, SetupError};
use crate::setup::{Bond, Particle, Setup};
use crate::space::search::{Search, half_of_shifts, pairs};
use crate::space::sphere::{nearest, periods};
use geom::Vec3;

/// All bonds at t = 0, by ids; their ends are positions in the list of particles by id.
pub fn bonded_pairs(setup: &Setup) -> Result<Vec<BondedPair>, SetupError> {
    let mut sorted: Vec<&Particle> = setup.particles.iter().collect();
    sorted.sort_unstable_by_key(|p| p.id);
    let gap = setup.bonds.iter().map(|b| b.gap).fold(0.0, f64::max);
    // What lies within rounding of a gap is left to the test of each pair.
    let reach: Vec<f64> = sorted.iter().map(|p| (p.radius + 0.5 * gap) * (1.0 + 1e-6)).collect();
    let points: Vec<Vec3> = sorted.iter().map(|p| p.position).collect();
    let mut used = vec![false; setup.bonds.len()];
    let (mut pairs, period) = (Vec::new(), periods(&setup.periodic));
    for [i, j] in near(setup, &points, &reach) {
        let (a, b) = (sorted[i as usize], sorted[j as usize]);
        let is_of =
            |law: &Bond| law.between == (a.material, b.material) || law.between == (b.material, a.material);
        let Some(n) = setup.bonds.iter().position(is_of) else { continue };
        let law = &setup.bonds[n];
        let arm = nearest(a.position - b.position, &period);
        let length = arm.norm();
        // Positions have so many digits.
        let digits = 4.0 * f64::EPSILON * (a.position.amax() + b.position.amax() + length);
        if length > a.radius + b.radius + law.gap + digits {
            continue;
        }
        if length <= 0.0 {
            return Err(SetupError::BondOfZeroLength { ids: [a.id, b.id] });
        }
        used[n] = true;
        let radius = law.radius_ratio * a.radius.min(b.radius);
        let mut beam = Beam::of_moduli(arm / length, [length, radius], [law.young, law.shear_modulus]);
        beam.lag = law.damping / frequency(&beam, [a, b], &setup.materials);
        let strength = [law.tensile_strength, law.shear_strength];
        pairs.push(BondedPair { ends: [i, j], beam, strength, broken: f64::INFINITY });
    }
    // Where particles come in, those of a rule may be among them.
    match used.iter().position(|used| !used).filter(|_| setup.inlets.is_empty()) {
        Some(n) => {
            let law = &setup.bonds[n];
            Err(SetupError::BondJoinsNothing { between: material_names(setup, law.between), gap: law.gap })
        }
        None => Ok(pairs),
    }
}

/// Pairs of positions in the list that may be near enough; each once.
fn near(setup: &Setup, points: &[Vec3], reach: &[f64]) -> Vec<[u32; 2]> {
    let search = Search::new(points, reach);
    let mut found = pairs(&search, &search.wide_pairs(), &(0..points.len()));
    let mut images = Vec::new();
    half_of_shifts(&setup.periodic).iter().for_each(|shift| search.shifted_pairs(shift, &mut images));
    found.extend(images.into_iter().map(|image| (image.i, image.j)));
    let row = |k: u32| search.order()[k as usize];
    let both = |(i, j)| [row(i).min(row(j)), row(i).max(row(j))];
    let mut found: Vec<[u32; 2]> = found.into_iter().map(both).collect();
    found.sort_unstable();
    found.dedup();
    found
}

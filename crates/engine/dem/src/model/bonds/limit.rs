//! What bonds leave of the time step. Derived in docs/theory/time-step.md.
//!
//! ```text
//! g:  along u (n, 0), twist (0, n), bending (0, e), shear (±e, −w L n × e)          for both e across n; springs k_n, k_t, k_b, k_s
//! λ = max over particles of the largest eigenvalue of Σ_bonds Σ_g k (1 + ε) M^(−½) g gᵀ M^(−½),   ε = (g_jᵀ M_j⁻¹ g_j)/(g_iᵀ M_i⁻¹ g_i)
//! λ (Δt²/4 + t Δt) = 1,  t: dashpots over springs;   1/Δt ≥ 1/Δt_contacts + 1/Δt_bonds
//! ```

use crate::model::bonds::NewBond;
use crate::model::bonds::find::{Grain, bonded_pairs, grains};
use crate::model::bonds::kinds::{End, numbers};
use crate::model::bonds::motions::{inverse, motions};
use crate::model::step_cause::root;
use crate::model::{BondedParticle, CriticalBonds, Limit, SetupError};
use crate::setup::{Bond, EntryBonds, Setup};
use crate::space::mass;
use geom::Vec3;
use nalgebra::{Matrix6, UnitQuaternion, Vector6};

/// The critical step of bonds [s], and the position in the list of the grain that bounds it; `None` without bonds. The ends of bonds are
/// positions in the list; `at` is the direction of each bond now.
pub fn critical(pairs: &[NewBond], grains: &[Grain], at: impl Fn(&NewBond) -> Vec3) -> Option<(f64, u32)> {
    // A block of 36 numbers for each end of a bond, and none for the grains beside them.
    let mut bonded: Vec<u32> = pairs.iter().flat_map(|t| t.ends).collect();
    bonded.sort_unstable();
    bonded.dedup();
    let mut blocks = vec![Matrix6::zeros(); bonded.len()];
    for pair in pairs {
        let inverse = pair.ends.map(|k| inverse(&grains[k as usize].end));
        let rows = pair.ends.map(|k| bonded.partition_point(|&b| b < k));
        add(&mut blocks, (pair, &at(pair), rows), inverse);
    }
    let largest = |block: &Matrix6<f64>| block.symmetric_eigenvalues().max();
    let (square, worst) = blocks.iter().map(largest).zip(bonded).max_by(|a, b| a.0.total_cmp(&b.0))?;
    let lag = pairs.iter().map(|t| t.numbers.lag).fold(0.0, f64::max);
    Some((root(square, square * lag), worst))
}

/// The particle that bounds the step of bonds that are there at the start, and that step [s]; `None` without bonds.
fn own(setup: &Setup) -> Result<Option<(f64, BondedParticle)>, SetupError> {
    if setup.bonds.is_empty() {
        return Ok(None);
    }
    let (pairs, grains) = (bonded_pairs(setup)?, grains(setup));
    let found = critical(&pairs, &grains, |pair| pair.numbers.axis);
    Ok(found.map(|(step, worst)| (step, bonded(setup, &grains[worst as usize]))))
}

/// A grain, for messages.
pub fn bonded(setup: &Setup, grain: &Grain) -> BondedParticle {
    let material = setup.materials[grain.material as usize].name.clone();
    BondedParticle { id: grain.end.id, material, radius: grain.end.radius }
}

/// What bonds that are made later leave of the step [s], as far as it is known before: a grain of the smallest size with twelve of its size around it.
/// Infinite where all bonds are made at the start.
fn later(setup: &Setup) -> f64 {
    let of = |law: &Bond| {
        let is_of = |material: u16| law.between.0 == material || law.between.1 == material;
        let radii = setup.particles.iter().filter(|p| is_of(p.material)).map(|p| p.radius);
        let radius = radii.fold(f64::INFINITY, f64::min);
        if radius.is_finite() { crowded(setup, law, radius) } else { f64::INFINITY }
    };
    setup.bonds.iter().filter(|law| law.at > 0.0).map(of).fold(f64::INFINITY, f64::min)
}

/// The critical step of a grain of a radius [m] that is bonded to twelve of its size, as in a dense lattice [s].
fn crowded(setup: &Setup, law: &Bond, radius: f64) -> f64 {
    let density = |material: u16| setup.materials[material as usize].density;
    let mass = mass(radius, density(law.between.0).min(density(law.between.1)));
    let grain = |k: u32, position: Vec3| {
        let end = End { id: k, radius, mass, turn: UnitQuaternion::identity() };
        Grain { row: k, end, material: law.between.0, cluster: 0, position }
    };
    let edge = std::f64::consts::SQRT_2 * radius;
    let signs = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
    let around = signs.iter().flat_map(|[a, b]| [[*a, *b, 0.0], [0.0, *a, *b], [*a, 0.0, *b]]);
    let places = std::iter::once(Vec3::zeros()).chain(around.map(|p| Vec3::from(p) * edge));
    let grains: Vec<Grain> = (0..).zip(places).map(|(k, place)| grain(k, place)).collect();
    let bond = |other: &Grain| NewBond {
        ends: [0, other.row],
        numbers: numbers(law, [grains[0].end, other.end], &-other.position),
    };
    let pairs: Vec<NewBond> = grains[1..].iter().map(bond).collect();
    critical(&pairs, &grains, |pair| pair.numbers.axis).map_or(f64::INFINITY, |(step, _)| step)
}

/// What a stage downstream has to know of the bonds of a setup.
///
/// # Errors
/// Bonds that are refused.
pub fn entries(setup: &Setup) -> Result<Option<EntryBonds>, SetupError> {
    let gap = setup.bonds.iter().map(|b| b.gap).fold(0.0, f64::max);
    let largest = setup.particles.iter().map(|p| p.radius).fold(0.0, f64::max);
    let mine = own(setup)?.map(|(step, _)| EntryBonds { step, longest: 2.0 * largest + gap });
    Ok(EntryBonds::union(mine, setup.entry_bonds))
}

/// Makes a limit so low that bonds are stable as well.
///
/// # Errors
/// Bonds that are refused.
pub fn tighten(limit: &mut Limit, setup: &Setup) -> Result<(), SetupError> {
    let (own, coming) = (own(setup)?, setup.entry_bonds.map_or(f64::INFINITY, |b| b.step).min(later(setup)));
    let alone = own.as_ref().map_or(coming, |(step, _)| step.min(coming));
    let with = 1.0 / (1.0 / limit.dt + 1.0 / alone);
    if with < 0.9 * limit.dt {
        let particle = own.filter(|(step, _)| *step == alone).map(|(_, p)| p);
        limit.cause.bonds = Some(CriticalBonds { particle, alone });
    }
    limit.dt = with;
    Ok(())
}

/// Adds a bond to the blocks of its ends, in these rows.
fn add(
    blocks: &mut [Matrix6<f64>],
    (pair, n, rows): (&NewBond, &Vec3, [usize; 2]),
    inverse: [Vector6<f64>; 2],
) {
    for motion in motions(&pair.numbers, n) {
        let scaled = [0, 1].map(|e| motion.ends[e].component_mul(&inverse[e].map(f64::sqrt)));
        let sum: f64 = scaled.iter().map(|g| g.norm_squared()).sum();
        for e in 0..2 {
            let own = scaled[e].norm_squared();
            if own > 0.0 {
                blocks[rows[e]] += scaled[e] * scaled[e].transpose() * (motion.stiffness * sum / own);
            }
        }
    }
}

//! What bonds leave of the time step. Derived in docs/time-step.md.
//!
//! ```text
//! g:  along u (n, 0), twist (0, n), bending (0, e), shear (±e, −L/2 n × e)          for both e across n; springs E A/L, G J/L, E I/L, 12 E I/L³
//! λ = max over particles of the largest eigenvalue of Σ_bonds Σ_g k (1 + ε) M^(−½) g gᵀ M^(−½),   ε = (g_jᵀ M_j⁻¹ g_j)/(g_iᵀ M_i⁻¹ g_i)
//! λ (Δt²/4 + t Δt) = 1,  t: dashpots over springs;   1/Δt ≥ 1/Δt_contacts + 1/Δt_bonds
//! ```

use crate::model::bonds::find::bonded_pairs;
use crate::model::bonds::motions::{inverse, motions};
use crate::model::step_cause::root;
use crate::model::{BondedPair, BondedParticle, CriticalBonds, Limit, SetupError};
use crate::setup::{EntryBonds, Particle, Setup};
use nalgebra::{Matrix6, Vector6};

/// The particle that bounds the step of bonds that are there at the start, and that step [s]; `None` without bonds.
fn own(setup: &Setup) -> Result<Option<(f64, &Particle)>, SetupError> {
    if setup.bonds.is_empty() {
        return Ok(None);
    }
    let pairs = bonded_pairs(setup)?;
    let mut sorted: Vec<&Particle> = setup.particles.iter().collect();
    sorted.sort_unstable_by_key(|p| p.id);
    // A block of 36 numbers for each end of a bond, and none for the grains beside them.
    let mut bonded: Vec<u32> = pairs.iter().flat_map(|t| t.ends).collect();
    bonded.sort_unstable();
    bonded.dedup();
    let mut blocks = vec![Matrix6::zeros(); bonded.len()];
    for pair in &pairs {
        let inverse = pair.ends.map(|k| inverse(sorted[k as usize], &setup.materials));
        let rows = pair.ends.map(|k| bonded.partition_point(|&b| b < k));
        add(&mut blocks, (pair, rows), inverse);
    }
    let largest = |block: &Matrix6<f64>| block.symmetric_eigenvalues().max();
    let all = blocks.iter().map(largest).zip(bonded);
    let Some((square, worst)) = all.max_by(|a, b| a.0.total_cmp(&b.0)) else { return Ok(None) };
    let lag = pairs.iter().map(|t| t.beam.lag).fold(0.0, f64::max);
    Ok(Some((root(square, square * lag), sorted[worst as usize])))
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
    let (own, coming) = (own(setup)?, setup.entry_bonds.map_or(f64::INFINITY, |b| b.step));
    let alone = own.map_or(coming, |(step, _)| step.min(coming));
    let with = 1.0 / (1.0 / limit.dt + 1.0 / alone);
    if with < 0.9 * limit.dt {
        let particle = own.filter(|(step, _)| *step == alone).map(|(_, p)| BondedParticle {
            id: p.id,
            material: setup.materials[p.material as usize].name.clone(),
            radius: p.radius,
        });
        limit.cause.bonds = Some(CriticalBonds { particle, alone });
    }
    limit.dt = with;
    Ok(())
}

/// Adds a bond to the blocks of its ends, in these rows.
fn add(blocks: &mut [Matrix6<f64>], (pair, rows): (&BondedPair, [usize; 2]), inverse: [Vector6<f64>; 2]) {
    for motion in motions(&pair.beam) {
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

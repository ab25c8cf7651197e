//! What bonds leave of the time step. Derived in docs/time-step.md.
//!
//! ```text
//! g:  along u (n, 0), twist (0, n), bending (0, e), shear (±e, −L/2 n × e)          for both e across n; springs E A/L, G J/L, E I/L, 12 E I/L³
//! λ = max over particles of the largest eigenvalue of Σ_bonds Σ_g k (1 + ε) M^(−½) g gᵀ M^(−½),   ε = (g_jᵀ M_j⁻¹ g_j)/(g_iᵀ M_i⁻¹ g_i)
//! λ (Δt²/4 + t Δt) = 1,  t: dashpots over springs;   1/Δt ≥ 1/Δt_contacts + 1/Δt_bonds
//! ```

use crate::effects::Material;
use crate::model::bonds::beam::Beam;
use crate::model::bonds::bonded_pair::BondedPair;
use crate::model::bonds::find::pairs_bonded;
use crate::model::error::SetupError;
use crate::model::limit::{Limit, root};
use crate::setup::{EntryBonds, Particle, Setup};
use crate::space::sphere::mass;
use geom::Vec3;
use nalgebra::{Matrix6, Vector6};

/// A motion of one end that a spring resists.
struct Motion {
    /// Stiffness [N/m or N·m/rad].
    stiffness: f64,
    /// Of i and of j.
    ends: [Vector6<f64>; 2],
}

/// Motions that a beam resists, each by itself; rotations are multiplied by the length, so that all are in metres.
fn motions(beam: &Beam) -> [Motion; 6] {
    let n = beam.axis;
    let side = (if n.x.abs() < 0.6 { Vec3::x() } else { Vec3::y() }).cross(&n).normalize();
    let across = [side, n.cross(&side)];
    let [along, bend, twist] = beam.springs;
    let motion = |stiffness: f64, push: Vec3, turns: [Vec3; 2]| {
        let end = |sign: f64, turn: Vec3| {
            let u = push * sign;
            Vector6::new(u.x, u.y, u.z, turn.x, turn.y, turn.z)
        };
        Motion { stiffness, ends: [end(1.0, turns[0]), end(-1.0, turns[1])] }
    };
    let shear = 12.0 * bend / (beam.length * beam.length);
    let still = Vec3::zeros();
    let sheared = across.map(|e| motion(shear, e, [n.cross(&e) * (-0.5 * beam.length); 2]));
    let bent = across.map(|e| motion(bend, still, [e, -e]));
    let ([s, t], [b, c]) = (sheared, bent);
    [motion(along, n, [still; 2]), motion(twist, still, [n, -n]), s, t, b, c]
}

/// 1/m and 1/I of a particle.
fn inverse(particle: &Particle, materials: &[Material]) -> Vector6<f64> {
    let m = mass(particle.radius, materials[particle.material as usize].density);
    let (push, turn) = (1.0 / m, 2.5 / (m * particle.radius * particle.radius));
    Vector6::new(push, push, push, turn, turn, turn)
}

/// The largest frequency of two bonded particles alone [rad/s], of the motions that a beam resists one by one.
pub fn frequency(beam: &Beam, ends: [&Particle; 2], materials: &[Material]) -> f64 {
    let inverse = ends.map(|p| inverse(p, materials));
    let square = |m: &Motion| {
        let of = |e: usize| m.ends[e].component_mul(&m.ends[e]).dot(&inverse[e]);
        m.stiffness * (of(0) + of(1))
    };
    motions(beam).iter().map(square).fold(0.0, f64::max).sqrt()
}

/// The particle that bounds the step of bonds that are there at the start, and that step [s]; `None` without bonds.
fn own(setup: &Setup) -> Result<Option<(f64, &Particle)>, SetupError> {
    if setup.bonds.is_empty() {
        return Ok(None);
    }
    let pairs_bonded = pairs_bonded(setup)?;
    let mut sorted: Vec<&Particle> = setup.particles.iter().collect();
    sorted.sort_unstable_by_key(|p| p.id);
    // A block of 36 numbers for each end of a bond, and none for the grains beside them.
    let mut bonded: Vec<u32> = pairs_bonded.iter().flat_map(|t| t.ends).collect();
    bonded.sort_unstable();
    bonded.dedup();
    let mut blocks = vec![Matrix6::zeros(); bonded.len()];
    for pair_bonded in &pairs_bonded {
        let inverse = pair_bonded.ends.map(|k| inverse(sorted[k as usize], &setup.materials));
        let places = pair_bonded.ends.map(|k| bonded.partition_point(|&b| b < k));
        add(&mut blocks, (pair_bonded, places), inverse);
    }
    let largest = |block: &Matrix6<f64>| block.symmetric_eigenvalues().max();
    let all = blocks.iter().map(largest).zip(bonded);
    let Some((square, worst)) = all.max_by(|a, b| a.0.total_cmp(&b.0)) else { return Ok(None) };
    let lag = pairs_bonded.iter().map(|t| t.beam.lag).fold(0.0, f64::max);
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
        let rest = if limit.dt.is_finite() { format!("; {}", limit.pair) } else { String::new() };
        let whose = match own.filter(|(step, _)| *step == alone) {
            None => "that come in".to_owned(),
            Some((_, p)) => {
                let name = &setup.materials[p.material as usize].name;
                format!("of particle {} ({name}, radius {:.4e} m", p.id, p.radius)
            }
        };
        let joint = if whose.contains('(') { ", " } else { " (" };
        limit.pair = format!("the bonds {whose}{joint}alone {alone:.4e} s){rest}");
    }
    limit.dt = with;
    Ok(())
}

/// Adds a bond to the blocks of its ends, which are at these places.
fn add(
    blocks: &mut [Matrix6<f64>],
    (pair_bonded, places): (&BondedPair, [usize; 2]),
    inverse: [Vector6<f64>; 2],
) {
    for motion in motions(&pair_bonded.beam) {
        let scaled = [0, 1].map(|e| motion.ends[e].component_mul(&inverse[e].map(f64::sqrt)));
        let sum: f64 = scaled.iter().map(|g| g.norm_squared()).sum();
        for e in 0..2 {
            let own = scaled[e].norm_squared();
            if own > 0.0 {
                blocks[places[e]] += scaled[e] * scaled[e].transpose() * (motion.stiffness * sum / own);
            }
        }
    }
}

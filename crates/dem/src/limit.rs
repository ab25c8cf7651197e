//! The largest stable time step.
//!
//! ```text
//! Δt(N, k) = 2/ω (√(1 + 4 ζ²) − 2 ζ),   ω² = N k/m*,  ζ = γ √N / 2
//! Δt_crit  = min { Δt(4, S), Δt(20, k_t), √(m*/20 k_t), 0.188/μ_r √(m*/S) }
//! S = dF_n/dδ at the overlap limit (Hertz) or k (Hooke); the last three where the scene asks for them
//! ```
//!
//! Δt(N, k) is where the integrator of [`crate::advance`] turns unstable (an eigenvalue of −1: (ω Δt)²/4 + 2 ζ ω Δt = 1, the
//! dashpot seeing the predicted velocity) for N contacts of stiffness k that pull at once. N = 4: Gershgorin's bound on a close
//! packing, twelve contacts, a third of their stiffness along any axis, each against a neighbour that moves the other way.
//! N = 20 = 40/7 × 7/2: the same packing with all grains turning one way, where translation and rotation both yield to a
//! tangential force, 1/m + r²/I = 7/2 · 1/m. √(m*/20 k_t): up to there the tangential spring, whose rate is predicted as well, takes more energy than
//! it makes without a dashpot. 0.188/μ_r: the dashpot of rolling resistance.

use crate::effects::damping_ratio;
use crate::error::SetupError;
use crate::law::{Elastic, tangential_ratio};
use crate::particles::mass;
use crate::setup::{Contact, Law, Setup, Wall, WallShape};

/// Several contacts at once.
const CONTACTS: f64 = 4.0;

/// A critical step and what sets it.
#[derive(Debug, Clone, PartialEq)]
pub struct Limit {
    /// Largest stable step [s].
    pub dt: f64,
    /// Materials and radii of the pair that sets it.
    pub pair: String,
}

/// The law of contact between two materials.
///
/// # Errors
/// When the setup has none for them.
pub fn contact_between(setup: &Setup, a: u16, b: u16) -> Result<&Contact, SetupError> {
    let matches = |c: &&Contact| c.between == (a, b) || c.between == (b, a);
    setup.contacts.iter().find(matches).ok_or_else(|| {
        let name = |m: u16| setup.materials[m as usize].name.clone();
        SetupError::NoContact { a: name(a), b: name(b) }
    })
}

/// Smallest and largest radius [m] of the particles of each material, those that inlets bring included.
pub fn radii_by_material(setup: &Setup) -> Vec<Option<(f64, f64)>> {
    let mut radii: Vec<Option<(f64, f64)>> = vec![None; setup.materials.len()];
    let mut widen = |material: u16, r: f64| {
        let range = &mut radii[material as usize];
        *range = Some(range.map_or((r, r), |(lo, hi)| (lo.min(r), hi.max(r))));
    };
    for p in &setup.particles {
        widen(p.material, p.radius);
    }
    for &m in setup.entry_materials.iter().filter(|_| setup.largest_entry > 0.0) {
        widen(m, setup.smallest_entry);
        widen(m, setup.largest_entry);
    }
    radii
}

/// The critical step of a setup: over every pair of materials that can meet, walls included.
///
/// # Errors
/// A pair without a law of contact.
pub fn critical_step(setup: &Setup) -> Result<Limit, SetupError> {
    let radii = radii_by_material(setup);
    let mut limit = Limit { dt: f64::INFINITY, pair: "no contact can occur".to_owned() };
    for (a, ra) in radii.iter().enumerate().filter_map(|(m, r)| r.map(|r| (m as u16, r.0))) {
        for (b, rb) in radii.iter().enumerate().filter_map(|(m, r)| r.map(|r| (m as u16, r.0))) {
            if a <= b {
                tighten(&mut limit, setup, (a, ra), (b, Partner::Particle(rb)))?;
            }
        }
        for wall in &setup.walls {
            tighten(&mut limit, setup, (a, ra), (wall.material, Partner::Wall(wall)))?;
        }
    }
    Ok(limit)
}

enum Partner<'a> {
    Particle(f64),
    Wall(&'a Wall),
}

fn tighten(
    limit: &mut Limit,
    setup: &Setup,
    (a, ra): (u16, f64),
    (b, partner): (u16, Partner),
) -> Result<(), SetupError> {
    let contact = contact_between(setup, a, b)?;
    let (first, second) = (&setup.materials[a as usize], &setup.materials[b as usize]);
    let ma = mass(ra, first.density);
    let (reduced_mass, radius, smaller, what) = match partner {
        Partner::Particle(rb) => {
            let mb = mass(rb, second.density);
            (ma * mb / (ma + mb), ra * rb / (ra + rb), ra.min(rb), format!("radius {rb:.4e} m"))
        }
        Partner::Wall(wall) => match &wall.shape {
            WallShape::Spheres(spheres) => {
                let rb = spheres.iter().map(|s| s.1).fold(0.0, f64::max);
                (ma, ra * rb / (ra + rb), ra.min(rb), format!("wall '{}'", wall.name))
            }
            _ => (ma, ra, ra, format!("wall '{}'", wall.name)),
        },
    };
    let elastic = Elastic::of(first, second);
    let stiffness = match contact.law {
        Law::Hooke { stiffness, .. } => stiffness,
        Law::Hertz => 2.0 * elastic.modulus * (radius * setup.guards.overlap * smaller).sqrt(),
    };
    let gamma = damping_ratio(contact.restitution);
    // K and C over m*, of several contacts at once; the predicted velocity doubles the dashpot's share.
    let step = |count: f64, k: f64| {
        let (omega, zeta) = ((count * k / reduced_mass).sqrt(), 0.5 * gamma * count.sqrt());
        2.0 / omega * ((1.0 + 4.0 * zeta * zeta).sqrt() - 2.0 * zeta)
    };
    let mut dt = step(CONTACTS, stiffness);
    if contact.sliding_friction.is_some() {
        // Twelve contacts of a close packing whose grains all turn the same way: 40/7 contacts of 7/2 k_t.
        let k = tangential_ratio(contact, elastic) * stiffness;
        dt = dt.min(step(20.0, k)).min((reduced_mass / (20.0 * k)).sqrt());
    }
    if let Some(resistance) = contact.rolling_resistance.filter(|&r| r > 0.0) {
        dt = dt.min(0.188 / resistance * (reduced_mass / stiffness).sqrt());
    }
    if dt < limit.dt {
        let pair = format!("{} (radius {ra:.4e} m) – {} ({what})", first.name, second.name);
        *limit = Limit { dt, pair };
    }
    Ok(())
}

//! The largest stable time step.
//!
//! ```text
//! ω² = 4 max(S, 7/2 k_t) / m*              S = dF_n/dδ at the overlap limit (Hertz) or k (Hooke)
//! Δt_crit = 2/ω (√(1 + ζ²) − ζ),  ζ = γ/2
//! ```
//!
//! A pair of masses on one spring has ω² = k/m*. 7/2: translation and rotation both yield to a tangential force,
//! 1/m + r²/I = 7/2 · 1/m. 4: several contacts pull at once; by Gershgorin's bound on a close packing (twelve contacts,
//! a third of their stiffness along any axis, each against a neighbour that moves the other way).
//! The factor with ζ: central differences with a dashpot that sees the predicted velocity (Belytschko, Liu & Moran
//! (2000), Nonlinear Finite Elements, §6.6).

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
                let smallest = spheres.iter().map(|s| s.1).fold(f64::INFINITY, f64::min);
                (ma, ra * rb / (ra + rb), ra.min(smallest), format!("wall '{}'", wall.name))
            }
            _ => (ma, ra, ra, format!("wall '{}'", wall.name)),
        },
    };
    let elastic = Elastic::of(first, second);
    let stiffness = match contact.law {
        Law::Hooke { stiffness, .. } => stiffness,
        Law::Hertz => 2.0 * elastic.modulus * (radius * setup.guards.overlap * smaller).sqrt(),
    };
    let tangential = contact.sliding_friction.map_or(0.0, |_| 3.5 * tangential_ratio(contact, elastic));
    let omega = (CONTACTS * stiffness * tangential.max(1.0) / reduced_mass).sqrt();
    let zeta = 0.5 * damping_ratio(contact.restitution);
    let dt = 2.0 / omega * ((1.0 + zeta * zeta).sqrt() - zeta);
    if dt < limit.dt {
        let pair = format!("{} (radius {ra:.4e} m) – {} ({what})", first.name, second.name);
        *limit = Limit { dt, pair };
    }
    Ok(())
}

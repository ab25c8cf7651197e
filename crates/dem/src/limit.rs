//! The largest stable time step.
//!
//! ```text
//! Δt(N, k) = 2/ω (√(1 + 4 ζ²) − 2 ζ),   ω² = N k/m*,  ζ = γ √N / 2
//! Δt_crit  = min { Δt(4, S), Δt(20, k_t), √(m*/20 k_t), 0.188/μ_r √(m*/S), Δt(10, k_t) }
//! S = k (Hooke), dF_n/dδ at the overlap limit (Hertz), 2 E* a there (JKR); all but the first where the scene asks for them
//! ```
//!
//! Δt(N, k) is where the integrator of [`crate::advance`] turns unstable (an eigenvalue of −1: (ω Δt)²/4 + 2 ζ ω Δt = 1, the
//! dashpot seeing the predicted velocity) for N contacts of stiffness k that pull at once. N = 4: Gershgorin's bound on a close
//! packing, twelve contacts, a third of their stiffness along any axis, each against a neighbour that moves the other way.
//! N = 20 = 40/7 × 7/2: the same packing with all grains turning one way, where translation and rotation both yield to a
//! tangential force, 1/m + r²/I = 7/2 · 1/m. √(m*/20 k_t): up to there the tangential spring, whose rate is predicted as well, takes more energy than
//! it makes without a dashpot. 0.188/μ_r: the dashpot of rolling resistance (spring). Δt(10, k_t), γ = 0.6: twisting, 4 × 5/2 k_t. Cohesion
//! only softens a contact, and the constant couple of rolling limits itself.

use crate::bodies::Yielding;
use crate::effects::{Jkr, damping_ratio};
use crate::error::SetupError;
use crate::law::{Elastic, reach, tangential_ratio};
use crate::particles::mass;
use crate::setup::{Contact, Law, Material, RollingModel, Setup, Wall, WallShape};

/// Several contacts at once.
const CONTACTS: f64 = 4.0;
/// γ of the dashpot of twisting, 2 η [–].
const TWISTING: f64 = 0.6;

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

/// Smallest and largest radius [m] of the particles of each material, members of clumps and those that inlets bring included.
pub fn radii_by_material(setup: &Setup) -> Vec<Option<(f64, f64)>> {
    let mut radii = free_radii(setup);
    for (material, low, high) in setup.clumps.radii() {
        let range = &mut radii[material as usize];
        *range = Some(range.map_or((low, high), |(l, h)| (l.min(low), h.max(high))));
    }
    radii
}

/// The like of spheres that belong to no clump.
fn free_radii(setup: &Setup) -> Vec<Option<(f64, f64)>> {
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

/// Grains that can meet others: a sphere, or a rigid clump with the mass by which it yields.
struct Grain {
    material: u16,
    /// Of the sphere that touches [m].
    radius: f64,
    /// 1/m to normal and to tangential forces [1/kg].
    yields: (f64, f64),
    name: Option<String>,
}

impl Grain {
    fn name(&self, materials: &[Material]) -> String {
        match &self.name {
            Some(clump) => format!("clump '{clump}' (radius {:.4e} m)", self.radius),
            None => format!("{} (radius {:.4e} m)", materials[self.material as usize].name, self.radius),
        }
    }
}

/// The smallest sphere of each material, and with clumps in the scene the largest, too: a small mass may be worse, or a large radius.
fn grains(setup: &Setup) -> Vec<Grain> {
    let clumps = setup.clumps.yielding(&setup.materials);
    let mut grains = Vec::new();
    for (material, range) in (0u16..).zip(free_radii(setup)) {
        let Some((low, high)) = range else { continue };
        for radius in if clumps.is_empty() { vec![low] } else { vec![low, high] } {
            let inverse = 1.0 / mass(radius, setup.materials[material as usize].density);
            grains.push(Grain { material, radius, yields: (inverse, inverse), name: None });
        }
    }
    grains.extend(clumps.into_iter().map(|c| {
        let Yielding { name, material, radius, normal, tangential } = c;
        Grain { material, radius, yields: (normal, tangential), name: Some(name) }
    }));
    grains
}

/// The critical step of a setup: over every pair of grains that can meet, walls included.
///
/// # Errors
/// A pair without a law of contact.
pub fn critical_step(setup: &Setup) -> Result<Limit, SetupError> {
    let grains = grains(setup);
    let mut limit = Limit { dt: f64::INFINITY, pair: "no contact can occur".to_owned() };
    for (k, a) in grains.iter().enumerate() {
        for b in &grains[k..] {
            tighten(&mut limit, setup, a, Partner::Grain(b))?;
        }
        for wall in &setup.walls {
            tighten(&mut limit, setup, a, Partner::Wall(wall))?;
        }
    }
    if let Some((rate, radius)) = setup.drag.and_then(|d| d.fastest_rate(setup)) {
        let with = 1.0 / (1.0 / limit.dt + rate);
        if with < 0.9 * limit.dt {
            limit.pair = format!(
                "[drag] on radius {radius:.4e} m (relaxation time {:.4e} s); {}",
                1.0 / rate,
                limit.pair
            );
        }
        limit.dt = with;
    }
    Ok(limit)
}

/// Largest gap at which any contact of a setup that was made still acts [m]: the skin is to be no less.
pub fn largest_reach(setup: &Setup) -> f64 {
    let radii = radii_by_material(setup);
    let of = |c: &Contact| {
        let (a, b) = (c.between.0 as usize, c.between.1 as usize);
        let largest = [radii[a], radii[b]].iter().flatten().map(|r| r.1).fold(0.0, f64::max);
        if largest > 0.0 {
            reach(c, Elastic::of(&setup.materials[a], &setup.materials[b]), largest)
        } else {
            0.0
        }
    };
    setup.contacts.iter().map(of).fold(0.0, f64::max)
}

enum Partner<'a> {
    Grain(&'a Grain),
    Wall(&'a Wall),
}

fn tighten(limit: &mut Limit, setup: &Setup, a: &Grain, partner: Partner) -> Result<(), SetupError> {
    let (ra, (normal, tangential)) = (a.radius, a.yields);
    let (other, yields, radius, smaller, what) = match partner {
        Partner::Grain(b) => {
            let (rb, (n, t)) = (b.radius, b.yields);
            let yields = (normal + n, tangential + t);
            (b.material, yields, ra * rb / (ra + rb), ra.min(rb), b.name(&setup.materials))
        }
        Partner::Wall(wall) => {
            let rb = match &wall.shape {
                WallShape::Spheres(spheres) => spheres.iter().map(|s| s.1).fold(0.0, f64::max),
                _ => f64::INFINITY,
            };
            let radius = if rb.is_finite() { ra * rb / (ra + rb) } else { ra };
            let what = format!("{} (wall '{}')", setup.materials[wall.material as usize].name, wall.name);
            (wall.material, a.yields, radius, ra.min(rb), what)
        }
    };
    let contact = contact_between(setup, a.material, other)?;
    let (first, second) = (&setup.materials[a.material as usize], &setup.materials[other as usize]);
    let elastic = Elastic::of(first, second);
    let stiffness = match contact.law {
        Law::Hooke { stiffness, .. } => stiffness,
        Law::Hertz => 2.0 * elastic.modulus * (radius * setup.guards.overlap * smaller).sqrt(),
        Law::Jkr { work_of_adhesion } => {
            let law = Jkr { modulus: elastic.modulus, work_of_adhesion, damping_ratio: 0.0 };
            let last = law.last_radius(radius);
            2.0 * elastic.modulus * last * Jkr::spread(setup.guards.overlap * smaller, radius, last).powi(2)
        }
    };
    let gamma = damping_ratio(contact.restitution);
    // K and C over m*, of several contacts at once; the predicted velocity doubles the dashpot's share.
    let step = |count: f64, k: f64, gamma: f64, inverse_mass: f64| {
        let (omega, zeta) = ((count * k * inverse_mass).sqrt(), 0.5 * gamma * count.sqrt());
        2.0 / omega * ((1.0 + 4.0 * zeta * zeta).sqrt() - 2.0 * zeta)
    };
    let mut dt = step(CONTACTS, stiffness, gamma, yields.0);
    if contact.sliding_friction.is_some() {
        // Twelve contacts of a close packing whose grains all turn the same way: 40/7 contacts of 7/2 k_t.
        let k = tangential_ratio(contact, elastic) * stiffness;
        dt = dt.min(step(20.0, k, gamma, yields.1)).min((20.0 * k * yields.1).sqrt().recip());
        if contact.twisting_resistance.is_some() {
            dt = dt.min(step(CONTACTS, 2.5 * k, TWISTING, yields.1));
        }
    }
    let spring = contact.rolling_model == RollingModel::Spring;
    if let Some(resistance) = contact.rolling_resistance.filter(|&r| spring && r > 0.0) {
        dt = dt.min(0.188 / resistance * (stiffness * yields.0).sqrt().recip());
    }
    if dt < limit.dt {
        *limit = Limit { dt, pair: format!("{} – {what}", a.name(&setup.materials)) };
    }
    Ok(())
}

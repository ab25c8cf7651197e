//! The largest stable time step. Derived in docs/time-step.md.
//!
//! ```text
//! Δt(A, B) = 2/(√(A + B²) + B)              the root of A Δt²/4 + B Δt = 1
//! Δt_crit  = min { Δt(4 a_n + 16 a_t, 4 b_n + 8 b_t), 1/√(20 a_t),
//!                  Δt(20 a_t + w A_r, 20 b_t + w B_r), Δt(w 20 a_t + A_r, w 20 b_t + B_r) }
//! a_n = S/m*,  b_n = γ √a_n,  a_t = k_t/m*,  b_t = γ √a_t          γ: damping ratio of the pair
//! A_r = s 10 a_t,  B_r = s (21.5 μ_r √a_n + 3.79 √a_t)             of rolling and twisting; s = (R*/r)² (½ + ½ r/r_larger)
//! 1/m* = c_i/m_i + c_j/m_j in a_n, a_t and w;  c = ((1 + q)/2)² for a sphere q times as large as the other, else 1
//! S = k (Hooke), dF_n/dδ at the overlap limit (Hertz), 2 E* a there (JKR);  w = |1/m_i − 1/m_j| m*;  r: the smaller radius
//! ```
//!
//! For rigid clumps 1/m* is that of their yielding in a_n and a_t, and b_n = γ √(S m*)/m*, b_t = γ √(k_t m*)/m* have m* of the whole
//! bodies under the root. Effects that the scene does not ask for count 0. The integrator of [`crate::advance`] turns unstable by an eigenvalue of −1:
//! A Δt²/4 + B Δt = 1, the dashpot seeing the predicted velocity. 4 and 8: twelve contacts, Σ n nᵀ = 4 and Σ (1 − n nᵀ) = 8,
//! each against a neighbour that moves the other way; 16: a tangential spring that is late by half a step, the most there is, counts
//! twice. c: as many times twelve small ones touch a large one (3 (1 + q)² together), which may be the lighter; the largest eigenvalue of the whole is
//! no more than those of both sides together. 20 = 8 × 5/2: all grains turn the same way. 1/√(20 a_t): up to there the
//! tangential spring, whose rate is predicted as well, takes more energy than it makes without a dashpot. Sliding resists
//! ω_i + ω_j, rolling and twisting ω_i − ω_j: they add up for a grain beside a wall (w = 1), and only the greater counts between
//! equals (w = 0). Cohesion only softens a contact, and the constant couple of rolling limits
//! itself ([`crate::effects::ConstantRolling`]). On a wall of spheres that lie deep within each other N push one way at once, Σ n nᵀ = N
//! ([`crate::crowd`]): where N > 4, all numbers of contacts count N/4 times.

use crate::effects::{
    ALONG, Elastic, Material, Meeting, NormalLaw, Slot, TURNS, TurningPair, active, damping_ratio,
    tangential_ratio,
};
use crate::model::crowd::{DenseWalls, met, rounding};
use crate::model::error::SetupError;
use crate::setup::clumps::ClumpCompliance;
use crate::setup::{ContactLaw, Drag, Setup, Wall};
use crate::space::sphere::mass;
use geom::Vec3;
use std::f64::consts::PI;

/// Σ (1 − n nᵀ) of the twelve contacts of a close packing [–].
const ACROSS: f64 = 8.0;

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
pub fn contact_between(setup: &Setup, a: u16, b: u16) -> Result<&ContactLaw, SetupError> {
    let matches = |c: &&ContactLaw| c.between == (a, b) || c.between == (b, a);
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

/// Smallest and largest radius of spheres that belong to no clump.
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
pub struct SizeClass {
    pub material: u16,
    /// Of the sphere that touches [m].
    pub radius: f64,
    /// 1/m [1/kg].
    pub inverse_mass: f64,
    /// 1/m to normal and to tangential forces [1/kg].
    yields: (f64, f64),
    name: Option<String>,
}

impl SizeClass {
    fn name(&self, materials: &[Material]) -> String {
        match &self.name {
            Some(clump) => format!("clump '{clump}' (radius {:.4e} m)", self.radius),
            None => format!("{} (radius {:.4e} m)", materials[self.material as usize].name, self.radius),
        }
    }
}

/// The smallest and the largest sphere of each material: a small mass may be worse, or a large radius.
pub fn grains(setup: &Setup) -> Vec<SizeClass> {
    let clumps = setup.clumps.yielding(&setup.materials);
    let mut grains = Vec::new();
    for (material, range) in (0u16..).zip(free_radii(setup)) {
        let Some((low, high)) = range else { continue };
        for radius in if low == high { vec![low] } else { vec![low, high] } {
            let inverse = 1.0 / mass(radius, setup.materials[material as usize].density);
            let yields = (inverse, inverse);
            grains.push(SizeClass { material, radius, inverse_mass: inverse, yields, name: None });
        }
    }
    grains.extend(clumps.into_iter().map(|c| {
        let ClumpCompliance { name, material, radius, inverse_mass, normal, tangential } = c;
        SizeClass { material, radius, inverse_mass, yields: (normal, tangential), name: Some(name) }
    }));
    grains
}

/// Largest radius of some grains [m].
pub fn largest(grains: &[SizeClass]) -> f64 {
    grains.iter().map(|g| g.radius).fold(0.0, f64::max)
}

/// The critical step of a setup: over every pair of grains that can meet, walls included.
///
/// # Errors
/// A pair without a law of contact, a material that is none.
pub fn critical_step(setup: &Setup) -> Result<Limit, SetupError> {
    crate::model::check::indices(setup)?;
    let grains = grains(setup);
    let crowds = DenseWalls::new(setup, largest(&grains));
    let mut limit = Limit { dt: f64::INFINITY, pair: "no contact can occur".to_owned() };
    for (k, a) in grains.iter().enumerate() {
        for b in &grains[k..] {
            tighten(&mut limit, setup, a, Partner::SizeClass(b))?;
        }
        for (w, wall) in setup.walls.iter().enumerate() {
            tighten(&mut limit, setup, a, Partner::Wall(wall, crowds.on(w, a.radius)))?;
        }
    }
    crate::model::bonds::limit::tighten(&mut limit, setup)?;
    if let Some((rate, radius)) = setup.drag.and_then(|d| fastest_drag(&d, setup)) {
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
    let of = |c: &ContactLaw| {
        let (a, b) = (c.between.0 as usize, c.between.1 as usize);
        let largest = [radii[a], radii[b]].iter().flatten().map(|r| r.1).fold(0.0, f64::max);
        let elastic = Elastic::of(&setup.materials[a], &setup.materials[b]);
        if largest > 0.0 { normal(c).map_or(0.0, |law| (law.reach)(c, elastic, largest)) } else { 0.0 }
    };
    setup.contacts.iter().map(of).fold(0.0, f64::max)
}

/// What is known of the normal law of a contact; `None` where it names none that there is.
pub(crate) fn normal(law: &ContactLaw) -> Option<NormalLaw> {
    active(law).find_map(|d| d.normal)
}

/// Largest stiffness of a contact up to an overlap [N/m].
pub(crate) fn stiffest(law: &ContactLaw, elastic: Elastic, at: Meeting) -> f64 {
    normal(law).map_or(f64::NAN, |known| (known.stiffest)(law, elastic, at))
}

enum Partner<'a> {
    SizeClass(&'a SizeClass),
    /// And how many times the four of a close packing push there.
    Wall(&'a Wall, f64),
}

fn tighten(limit: &mut Limit, setup: &Setup, a: &SizeClass, partner: Partner) -> Result<(), SetupError> {
    let (ra, (normal, tangential)) = (a.radius, a.yields);
    let (other, yields, uneven, radius, (smaller, larger), what, dense) = match &partner {
        Partner::SizeClass(b) => {
            let (rb, (n, t)) = (b.radius, b.yields);
            let (mine, its) = (crowd(ra, rb), crowd(rb, ra));
            let yields = (mine * normal + its * n, mine * tangential + its * t);
            let sizes = (ra.min(rb), ra.max(rb));
            let uneven = (mine * normal - its * n).abs();
            (b.material, yields, uneven, ra * rb / (ra + rb), sizes, b.name(&setup.materials), 1.0)
        }
        Partner::Wall(wall, dense) => {
            let (rb, (radius, smaller)) = (rounding(wall), met(wall, ra));
            let material = &setup.materials[wall.material as usize].name;
            let many = if *dense > 1.0 {
                format!(", {} of its spheres at once", ALONG * *dense)
            } else {
                String::new()
            };
            let what = format!("{material} (wall '{}'{many})", wall.name);
            // Wall spheres may lie within each other, so that there may be many however large they are.
            let sizes = if rb.is_finite() { (smaller, smaller) } else { (ra, rb) };
            (wall.material, a.yields, normal, radius, sizes, what, *dense)
        }
    };
    let contact = contact_between(setup, a.material, other)?;
    let (first, second) = (&setup.materials[a.material as usize], &setup.materials[other as usize]);
    let elastic = Elastic::of(first, second);
    let stiffness = stiffest(contact, elastic, Meeting { radius, smaller, share: setup.guards.overlap });
    let inverse_mass =
        a.inverse_mass + if let Partner::SizeClass(b) = partner { b.inverse_mass } else { 0.0 };
    let between = PairBound {
        stiffness,
        tangential: tangential_ratio(contact, elastic) * stiffness,
        yields,
        mass: 1.0 / inverse_mass,
        uneven: uneven / yields.0,
        turning: (radius / smaller).powi(2) * (0.5 + 0.5 * smaller / larger),
        dense,
    };
    let dt = between.step(contact);
    if dt < limit.dt {
        *limit = Limit { dt, pair: format!("{} – {what}", a.name(&setup.materials)) };
    }
    Ok(())
}

/// How many times twelve grains of radius `other` [m] find place on one of radius `own` [m]; no fewer than once.
fn crowd(own: f64, other: f64) -> f64 {
    (0.5 * (1.0 + own / other)).powi(2).max(1.0)
}

/// What bounds the step of a pair.
struct PairBound {
    /// S and k_t [N/m].
    stiffness: f64,
    tangential: f64,
    /// 1/m* to normal and to tangential forces [1/kg].
    yields: (f64, f64),
    /// m* that dashpots are made for [kg].
    mass: f64,
    /// w [–].
    uneven: f64,
    /// s [–].
    turning: f64,
    /// N/4, at least 1 [–].
    dense: f64,
}

/// The root of A Δt²/4 + B Δt = 1.
pub(crate) fn root(a: f64, b: f64) -> f64 {
    2.0 / ((a + b * b).sqrt() + b)
}

impl PairBound {
    fn step(&self, contact: &ContactLaw) -> f64 {
        let gamma = damping_ratio(contact.number("restitution").unwrap_or(f64::NAN));
        let (along, across) = (self.stiffness * self.yields.0, self.tangential * self.yields.1);
        let impedance = (self.stiffness * self.mass).sqrt();
        let (pull, turn) = (impedance * self.yields.0, impedance * self.yields.1);
        let rub = (self.tangential * self.mass).sqrt() * self.yields.1;
        let (straight, sideways) = (ALONG * self.dense, ACROSS * self.dense);
        if !active(contact).any(|d| d.slot == Slot::Sliding) {
            return root(straight * along, straight * gamma * pull);
        }
        let moves =
            root(straight * along + 2.0 * sideways * across, gamma * (straight * pull + sideways * rub));
        let slide = sideways * TURNS;
        let pair = TurningPair {
            dense: self.dense,
            share: self.turning,
            tangential: across,
            impedance: turn,
            tangential_impedance: rub,
        };
        let (mut a, mut b) = (0.0, 0.0);
        for resists in active(contact).filter_map(|d| d.turning) {
            let more = resists(contact, &pair);
            (a, b) = (a + more.stiffness, b + more.damping);
        }
        let w = self.uneven;
        let slides = root(slide * across + w * a, slide * gamma * rub + w * b);
        let turns = root(w * slide * across + a, w * slide * gamma * rub + b);
        moves.min(slides).min(turns).min((slide * across).sqrt().recip())
    }
}

/// Largest d|F|/d|w| / m [1/s] that is to be expected: at the speeds of the start, and of a fall without end after Stokes.
fn fastest_drag(drag: &Drag, setup: &Setup) -> Option<(f64, f64)> {
    let relative = |v: &Vec3| (v - drag.velocity).norm();
    let bodies = setup.clumps.bodies.iter().map(|b| &b.velocity);
    let all = setup.particles.iter().map(|p| &p.velocity).chain(bodies);
    let start = all.map(relative).fold(drag.velocity.norm(), f64::max);
    let materials = radii_by_material(setup).into_iter().zip(&setup.materials);
    let ranges = materials.filter_map(|(r, m)| r.map(|(low, high)| [(low, m.density), (high, m.density)]));
    let all = ranges.flatten().map(|(radius, density)| {
        let inverse_mass = 1.0 / mass(radius, density);
        let slow = 6.0 * PI * drag.viscosity * radius * inverse_mass;
        let speed = start.max(setup.gravity.norm() / slow);
        (drag.slope(radius, speed) * slow, radius)
    });
    all.max_by(|a, b| a.0.total_cmp(&b.0))
}

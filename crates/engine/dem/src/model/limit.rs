//! The largest stable time step. Derived in docs/theory/time-step.md.
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
//! clumps under the root. Effects that the scene does not ask for count 0. The integrator of [`laws::contact::motion`] turns unstable by an eigenvalue of −1:
//! A Δt²/4 + B Δt = 1, the dashpot seeing the predicted velocity. 4 and 8: twelve contacts, Σ n nᵀ = 4 and Σ (1 − n nᵀ) = 8,
//! each against a neighbour that moves the other way; 16: a tangential spring that is late by half a step, the most there is, counts
//! twice. c: as many times twelve small ones touch a large one (3 (1 + q)² together), which may be the lighter; the largest eigenvalue of the whole is
//! no more than those of both sides together. 20 = 8 × 5/2: all grains turn the same way. 1/√(20 a_t): up to there the
//! tangential spring, whose rate is predicted as well, takes more energy than it makes without a dashpot. Sliding resists
//! ω_i + ω_j, rolling and twisting ω_i − ω_j: they add up for a grain beside a wall (w = 1), and only the greater counts between
//! equals (w = 0). Cohesion only softens a contact, and the constant torque of rolling limits
//! itself ([`laws::effects::ConstantRolling`]). On a wall of spheres that lie deep within each other N push one way at once, Σ n nᵀ = N
//! ([`crate::model::dense_walls`]): where N > 4, all numbers of contacts count N/4 times.

use crate::model::dense_walls::{met, rounding};
use crate::model::in_range::indices;
use crate::model::step_cause::root;
use crate::model::{
    CriticalDrag, CriticalGrain, CriticalPair, CriticalPartner, DenseWalls, Limit, RepeatedMotion,
    SetupError, StepCause,
};
use crate::setup::clumps::{SizeClass, widen};
use crate::setup::{ContactLaw, Drag, Setup, Step, Wall, WallShape};
use crate::space::mass;
use geom::Vec3;
use laws::effects::{
    ALONG, Elastic, Material, NormalLaw, OverlapLimit, Slot, TurningPair, active, damping_ratios,
    tangential_ratio,
};
use laws::space::sphere::TURNS;
use std::f64::consts::PI;

/// Σ (1 − n nᵀ) of the twelve contacts of a close packing [–].
const ACROSS: f64 = 8.0;

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
        widen(&mut radii[material as usize], low, high);
    }
    radii
}

/// Smallest and largest radius of spheres that belong to no clump.
fn free_radii(setup: &Setup) -> Vec<Option<(f64, f64)>> {
    let mut radii: Vec<Option<(f64, f64)>> = vec![None; setup.materials.len()];
    for p in &setup.particles {
        widen(&mut radii[p.material as usize], p.radius, p.radius);
    }
    for &m in setup.entry_materials.iter().filter(|_| setup.largest_entry > 0.0) {
        widen(&mut radii[m as usize], setup.smallest_entry, setup.largest_entry);
    }
    radii
}

impl SizeClass {
    /// As it is named where it sets the step.
    fn critical(&self, materials: &[Material]) -> CriticalGrain {
        let radius = self.radius;
        match self.shape.clone() {
            Some(shape) => CriticalGrain::Clump { shape, radius },
            None => {
                let material = materials[self.material as usize].name.clone();
                CriticalGrain::Sphere { material, radius }
            }
        }
    }
}

/// The smallest and the largest sphere of each material: a small mass may be worse, or a large radius.
pub fn grains(setup: &Setup) -> Vec<SizeClass> {
    let mut grains = Vec::new();
    for (material, range) in (0u16..).zip(free_radii(setup)) {
        let Some((low, high)) = range else { continue };
        for radius in if low == high { vec![low] } else { vec![low, high] } {
            let inverse_mass = 1.0 / mass(radius, setup.materials[material as usize].density);
            let (normal, tangential) = (inverse_mass, inverse_mass);
            grains.push(SizeClass { shape: None, material, radius, inverse_mass, normal, tangential });
        }
    }
    grains.extend(setup.clumps.yielding(&setup.materials));
    grains
}

/// Largest radius of some grains [m].
pub fn largest(grains: &[SizeClass]) -> f64 {
    grains.iter().map(|g| g.radius).fold(0.0, f64::max)
}

/// The critical step of contacts alone: over every pair of grains that can meet, walls included.
///
/// # Errors
/// A pair of materials without a contact law.
pub fn critical_of_contacts(setup: &Setup) -> Result<Limit, SetupError> {
    let grains = grains(setup);
    let crowds = DenseWalls::new(setup, largest(&grains));
    let mut limit = Limit { dt: f64::INFINITY, cause: StepCause::default() };
    for (k, a) in grains.iter().enumerate() {
        for b in &grains[k..] {
            tighten(&mut limit, setup, a, Partner::SizeClass(b))?;
        }
        for (w, wall) in setup.walls.iter().enumerate() {
            tighten(&mut limit, setup, a, Partner::Wall(wall, crowds.on(w, a.radius)))?;
        }
    }
    Ok(limit)
}

/// The critical step of a setup.
///
/// # Errors
/// A pair of materials without a contact law, an index beyond the materials, bonds that are refused.
pub fn critical_step(setup: &Setup) -> Result<Limit, SetupError> {
    indices(setup)?;
    let mut limit = critical_of_contacts(setup)?;
    crate::model::bonds::limit::tighten(&mut limit, setup)?;
    // A force that slows a particle counts so many times.
    limit.dt /= 1.0 + setup.local_damping.unwrap_or(0.0);
    if let Some((rate, radius)) = setup.drag.and_then(|d| fastest_drag(&d, setup)) {
        let with = 1.0 / (1.0 / limit.dt + rate);
        if with < 0.9 * limit.dt {
            limit.cause.drag = Some(CriticalDrag { radius, relaxation_time: 1.0 / rate });
        }
        limit.dt = with;
    }
    let share = if let Step::Auto(share) = setup.step { share } else { 1.0 };
    limit.cause.motion = fastest_motion(setup).filter(|motion| motion.step() < share * limit.dt);
    Ok(limit)
}

/// The wall whose motion repeats fastest. A plane that turns in itself stays as it is; all else that turns may have an edge.
fn fastest_motion(setup: &Setup) -> Option<RepeatedMotion> {
    let of = |wall: &Wall| {
        let turns = if matches!(wall.shape, WallShape::Plane(_)) { 0.0 } else { wall.motion.fastest_turn() };
        let spring = wall.mount.map_or(0.0, |m| (m.stiffness / m.mass).sqrt() / (2.0 * PI));
        let rate = wall.motion.vibration().max(turns / (2.0 * PI)).max(spring);
        (rate > 0.0).then(|| RepeatedMotion { wall: wall.name.clone(), period: 1.0 / rate })
    };
    setup.walls.iter().filter_map(of).min_by(|a, b| a.period.total_cmp(&b.period))
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
pub(crate) fn stiffest(law: &ContactLaw, elastic: Elastic, at: OverlapLimit) -> f64 {
    normal(law).map_or(f64::NAN, |known| (known.stiffest)(law, elastic, at))
}

enum Partner<'a> {
    SizeClass(&'a SizeClass),
    /// And how many times the four of a close packing push there.
    Wall(&'a Wall, f64),
}

impl Partner<'_> {
    /// As it is named where it sets the step.
    fn critical(&self, setup: &Setup) -> CriticalPartner {
        match self {
            Partner::SizeClass(grain) => CriticalPartner::Grain(grain.critical(&setup.materials)),
            Partner::Wall(wall, dense) => CriticalPartner::Wall {
                material: setup.materials[wall.material as usize].name.clone(),
                wall: wall.name.clone(),
                spheres: (*dense > 1.0).then_some(ALONG * *dense),
            },
        }
    }
}

fn tighten(limit: &mut Limit, setup: &Setup, a: &SizeClass, partner: Partner) -> Result<(), SetupError> {
    let SizeClass { radius: ra, normal, tangential, .. } = *a;
    let (other, yields, uneven, radius, (smaller, larger), dense) = match &partner {
        Partner::SizeClass(b) => {
            let rb = b.radius;
            let (mine, its) = (crowd(ra, rb), crowd(rb, ra));
            let yields = (mine * normal + its * b.normal, mine * tangential + its * b.tangential);
            let sizes = (ra.min(rb), ra.max(rb));
            let uneven = (mine * normal - its * b.normal).abs();
            (b.material, yields, uneven, ra * rb / (ra + rb), sizes, 1.0)
        }
        Partner::Wall(wall, dense) => {
            let (rb, (radius, smaller)) = (rounding(wall), met(wall, ra));
            // Wall spheres may lie within each other, so that there may be many however large they are.
            let sizes = if rb.is_finite() { (smaller, smaller) } else { (ra, rb) };
            (wall.material, (normal, tangential), normal, radius, sizes, *dense)
        }
    };
    let contact = contact_between(setup, a.material, other)?;
    let (first, second) = (&setup.materials[a.material as usize], &setup.materials[other as usize]);
    let elastic = Elastic::of(first, second);
    let stiffness = stiffest(contact, elastic, OverlapLimit { radius, smaller, share: setup.guards.overlap });
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
        let pair = CriticalPair { grain: a.critical(&setup.materials), partner: partner.critical(setup) };
        *limit = Limit { dt, cause: StepCause { pair: Some(pair), ..StepCause::default() } };
    }
    Ok(())
}

/// How many times twelve grains of radius `other` [m] fit around one of radius `own` [m]; at least 1.
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

impl PairBound {
    fn step(&self, contact: &ContactLaw) -> f64 {
        let (along, across) = (self.stiffness * self.yields.0, self.tangential * self.yields.1);
        let impedance = (self.stiffness * self.mass).sqrt();
        let (pull, turn) = (impedance * self.yields.0, impedance * self.yields.1);
        let tangential = (self.tangential * self.mass).sqrt();
        let rub = tangential * self.yields.1;
        let [gamma, rubs] = damping_ratios(contact, [impedance, tangential]);
        let (straight, sideways) = (ALONG * self.dense, ACROSS * self.dense);
        if !active(contact).any(|d| d.slot == Slot::Sliding) {
            return root(straight * along, straight * gamma * pull);
        }
        let moves =
            root(straight * along + 2.0 * sideways * across, straight * gamma * pull + sideways * rubs * rub);
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
        let slides = root(slide * across + w * a, slide * rubs * rub + w * b);
        let turns = root(w * slide * across + a, w * slide * rubs * rub + b);
        moves.min(slides).min(turns).min((slide * across).sqrt().recip())
    }
}

/// Largest d|F|/d|w| / m [1/s] that is to be expected: at the speeds of the start, and of a fall without end after Stokes.
fn fastest_drag(drag: &Drag, setup: &Setup) -> Option<(f64, f64)> {
    let relative = |v: &Vec3| (v - drag.velocity).norm();
    let clumps = setup.clumps.placed.iter().map(|b| &b.velocity);
    let all = setup.particles.iter().map(|p| &p.velocity).chain(clumps);
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

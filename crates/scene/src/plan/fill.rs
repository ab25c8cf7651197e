//! `[[fill]]`: spheres at random places of a shape, one after the other, none touching another.
//!
//! The largest go first (they find room while there is some); each has its diameter and its tries from the
//! stream of random numbers of its own fill, so that a fill does not depend on the ones before it except for
//! the room they left.

use crate::check::Check;
use crate::error::SceneError;
use crate::model::{Diameter, Fill};
use crate::room::{Occupied, bounds, holds};
use dem::setup::Particle;
use geom::{Shape, Vec3};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::f64::consts::PI;

/// Tries for a place before the shape counts as full.
const TRIES: usize = 20_000;
/// More than this is a slip of the pen, or needs another program.
const MOST: u64 = 50_000_000;

/// A number in [0, 1), from the highest 53 bits: portable, and free of the details of `rand`.
pub(crate) fn unit(random: &mut Pcg64Mcg) -> f64 {
    (random.next_u64() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
}

/// A generator for one thing of a scene: `kind` and `index` keep streams of one seed apart.
pub(crate) fn generator(seed: u64, kind: u64, index: u64) -> Pcg64Mcg {
    let mut state = seed ^ kind.rotate_left(32) ^ index.rotate_left(48);
    let mut next = || {
        // SplitMix64 (Steele, Lea & Flood 2014, doi:10.1145/2660193.2660195).
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let a = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let b = (a ^ (a >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        b ^ (b >> 31)
    };
    let mut bytes = [0; 16];
    bytes[..8].copy_from_slice(&next().to_le_bytes());
    bytes[8..].copy_from_slice(&next().to_le_bytes());
    Pcg64Mcg::from_seed(bytes)
}

/// A diameter of the range [m].
pub(crate) fn diameter(range: Diameter, random: &mut Pcg64Mcg) -> f64 {
    range.low + (range.high - range.low) * unit(random)
}

/// Volume of a sphere [m³].
pub(crate) fn volume(radius: f64) -> f64 {
    4.0 / 3.0 * PI * radius * radius * radius
}

/// The particles of a fill; `taken` are all spheres that are placed: centre, radius [m].
///
/// # Errors
/// A shape without end or without room, with what did fit.
pub(crate) fn fill(
    check: &Check,
    index: usize,
    fill: &Fill,
    shape: &Shape,
    material: (u16, f64),
    first_id: u32,
    taken: &[(Vec3, f64)],
) -> Result<Vec<Particle>, SceneError> {
    let key = |k: &str| format!("fill.{index}.{k}");
    let Some((low, high)) = bounds(shape) else {
        let why = "cannot be filled: only box, sphere and cylinder (without '!') can";
        return Err(check.wrong(
            &key("shape"),
            &fill.shape,
            why,
            "use one of these, or [[particles]] from a file",
        ));
    };
    let mut random = generator(fill.seed, 1, index as u64);
    let radii = radii(check, &key("mass"), fill, material.1, &mut random)?;
    let mut room = Place::new(shape, (low, high), fill.diameter.high / 2.0, taken);
    let wanted: f64 = radii.iter().map(|r| volume(*r)).sum();
    let mut placed = 0.0;
    let mut particles = Vec::with_capacity(radii.len());
    for (n, &radius) in radii.iter().enumerate() {
        let Some(position) = room.find(radius, &mut random) else {
            let (fits, of) = (placed * material.1, wanted * material.1);
            let why = format!(
                "only {n} of {} particles ({fits:.4} of {of:.4} kg) fit without touching",
                radii.len()
            );
            let cure =
                "make the shape larger (random places fill about a third of it), or pour with [[insert]]";
            return Err(check.wrong(&key("shape"), &fill.shape, &why, cure));
        };
        placed += volume(radius);
        let velocity = Vec3::from(fill.velocity);
        let id = first_id.wrapping_add(n as u32);
        particles.push(Particle {
            id,
            material: material.0,
            radius,
            position,
            velocity,
            spin: Vec3::zeros(),
        });
    }
    Ok(particles)
}

/// The radii, largest first; as many as come nearest to the mass.
fn radii(
    check: &Check,
    key: &str,
    fill: &Fill,
    density: f64,
    random: &mut Pcg64Mcg,
) -> Result<Vec<f64>, SceneError> {
    let smallest = volume(fill.diameter.low / 2.0) * density;
    let most = fill.count.unwrap_or_else(|| (fill.mass.unwrap_or(0.0) / smallest) as u64);
    if most > MOST {
        let why = "makes more than fifty million particles";
        let key = if fill.count.is_some() { key.replace(".mass", ".count") } else { key.to_owned() };
        return Err(check.wrong(&key, format!("{most} particles"), why, "ask for fewer or larger ones"));
    }
    let mut radii = Vec::new();
    let mut mass = 0.0;
    loop {
        let radius = diameter(fill.diameter, random) / 2.0;
        let more = volume(radius) * density;
        let enough = match (fill.count, fill.mass) {
            (Some(count), _) => radii.len() as u64 >= count,
            (None, wanted) => mass + more / 2.0 > wanted.unwrap_or(0.0),
        };
        if enough {
            break;
        }
        mass += more;
        radii.push(radius);
    }
    if radii.is_empty() && fill.mass.is_some() {
        let value = format!("{} kg", fill.mass.unwrap_or(0.0));
        return Err(check.wrong(key, value, "is less than half a particle", "give more mass, or count"));
    }
    radii.sort_by(|a, b| b.total_cmp(a));
    Ok(radii)
}

/// Room in a shape that spheres take one after the other.
pub(crate) struct Place<'a> {
    shape: &'a Shape,
    low: Vec3,
    high: Vec3,
    room: Occupied,
}

impl<'a> Place<'a> {
    /// A shape between two corners, what is `taken` in it, and the largest radius that is to come [m].
    pub(crate) fn new(
        shape: &'a Shape,
        (low, high): (Vec3, Vec3),
        largest: f64,
        taken: &[(Vec3, f64)],
    ) -> Place<'a> {
        let largest = taken.iter().map(|s| s.1).fold(largest, f64::max);
        let mut room = Occupied::new(low, high, largest);
        let near = |p: &Vec3| (0..3).all(|a| p[a] > low[a] - 2.0 * largest && p[a] < high[a] + 2.0 * largest);
        taken.iter().filter(|s| near(&s.0)).for_each(|s| room.take(s.0, s.1));
        Place { shape, low, high, room }
    }

    /// A random place for one more sphere, that it takes; `None` when there is none.
    pub(crate) fn find(&mut self, radius: f64, random: &mut Pcg64Mcg) -> Option<Vec3> {
        let (low, size) = (self.low.add_scalar(radius), (self.high - self.low).add_scalar(-2.0 * radius));
        if size.min() < 0.0 {
            return None;
        }
        let found = (0..TRIES).find_map(|_| {
            let at = low + Vec3::new(unit(random), unit(random), unit(random)).component_mul(&size);
            (holds(self.shape, &at, radius) && self.room.is_free(&at, radius)).then_some(at)
        })?;
        self.room.take(found, radius);
        Some(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::Text;

    fn poured(shape: &str, mass: f64, seed: u64) -> Result<Vec<Particle>, SceneError> {
        let text = Text::new("s", String::new());
        let entry = Fill {
            material: "m".into(),
            clump: None,
            scale: None,
            shape: shape.into(),
            diameter: Diameter { low: 0.01, high: 0.02 },
            mass: Some(mass),
            count: None,
            velocity: [0.0; 3],
            seed,
        };
        let solid = shape.parse().unwrap();
        fill(&Check { text: &text }, 0, &entry, &solid, (0, 1000.0), 7, &[])
    }

    #[test]
    fn a_fill_has_its_mass_lies_inside_and_touches_nothing() {
        let shape = "cylinder:0,0,0,0,0,0.2,0.1";
        let found = poured(shape, 1.0, 0).unwrap();
        let mass: f64 = found.iter().map(|p| 1000.0 * volume(p.radius)).sum();
        assert!((mass - 1.0).abs() < 1000.0 * volume(0.01), "{mass} kg");
        for (i, p) in found.iter().enumerate() {
            assert!((0.005..=0.01).contains(&p.radius) && p.position.xy().norm() + p.radius <= 0.1 + 1e-12);
            assert!(found[..i].iter().all(|q| (q.position - p.position).norm() >= q.radius + p.radius));
        }
        assert_eq!((found[0].id, found.len()), (7, found.last().unwrap().id as usize - 6));
        assert_eq!(found, poured(shape, 1.0, 0).unwrap());
        assert_ne!(found, poured(shape, 1.0, 1).unwrap());
    }

    #[test]
    fn what_does_not_fit_is_told() {
        let message = poured("box:0,0,0,0.1,0.1,0.1", 5.0, 0).unwrap_err().to_string();
        assert!(message.contains("kg) fit without touching") && message.contains("[[insert]]"), "{message}");
        assert!(poured("halfspace:0,0,0,0,0,1", 5.0, 0).unwrap_err().to_string().contains("only box"));
    }
}

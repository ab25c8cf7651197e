//! `[[fill]]`: spheres at random places of a shape, one after the other, none touching another.
//!
//! The largest go first, while there is space. Diameters and positions come from random numbers of this fill alone, so that
//! a fill depends on the ones before it only by the space they left.

use super::inserted::GrainMaterial;
use super::packing::{Packing, bounds};
use super::random::{diameter, generator};
use crate::check::Check;
use crate::error::SceneError;
use crate::keys::Fill;
use dem::setup::Particle;
use geom::{Shape, Vec3, sphere::volume};
use rand_pcg::Pcg64Mcg;

/// More than this is a mistake, or needs another program.
const MOST: u64 = 50_000_000;

/// A `[[fill]]` of spheres.
pub(super) struct FillRequest<'a> {
    /// Index of the entry.
    pub index: usize,
    pub entry: &'a Fill,
    pub shape: &'a Shape,
    pub material: GrainMaterial,
    pub first_id: u32,
    /// All spheres that are placed already: centre, radius [m].
    pub taken: &'a [(Vec3, f64)],
}

/// The particles of a fill.
///
/// # Errors
/// A shape without end, or without room for all; the message says how many fit.
pub(super) fn fill(check: &Check, request: &FillRequest) -> Result<Vec<Particle>, SceneError> {
    let FillRequest { index, entry, shape, material, first_id, taken } = *request;
    let key = |k: &str| format!("fill.{index}.{k}");
    let Some((low, high)) = bounds(shape) else {
        let why = "cannot be filled: only box, sphere and cylinder (without '!') can";
        let cure = "use one of these, or [[particles]] from a file";
        return Err(check.wrong(&key("shape"), &entry.shape, why, cure));
    };
    let mut random = generator(entry.seed, 1, index as u64);
    let radii = radii(check, &key("mass"), entry, material.density, &mut random)?;
    let mut packing = Packing::new(shape, (low, high), entry.diameter.high / 2.0, taken);
    let wanted: f64 = radii.iter().map(|r| volume(*r)).sum();
    let mut placed = 0.0;
    let mut particles = Vec::with_capacity(radii.len());
    for (n, &radius) in radii.iter().enumerate() {
        let Some(position) = packing.place(radius, &mut random) else {
            let (fits, of) = (placed * material.density, wanted * material.density);
            let count = radii.len();
            let why = format!("only {n} of {count} particles ({fits:.4} of {of:.4} kg) fit without touching");
            return Err(check.wrong(&key("shape"), &entry.shape, &why, LARGER));
        };
        placed += volume(radius);
        let (velocity, spin) = (Vec3::from(entry.velocity), Vec3::zeros());
        let id = first_id.wrapping_add(n as u32);
        particles.push(Particle { id, material: material.index, radius, position, velocity, spin });
    }
    Ok(particles)
}

/// The cure for a shape that is too small.
pub(super) const LARGER: &str =
    "make the shape larger (random places fill about a third of it), or pour with [[insert]]";

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keys::Diameter;
    use crate::text::Text;

    fn filled(shape: &str, mass: f64, seed: u64) -> Result<Vec<Particle>, SceneError> {
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
        let (shape, material) = (shape.parse().unwrap(), GrainMaterial { index: 0, density: 1000.0 });
        let (entry, shape) = (&entry, &shape);
        let request = FillRequest { index: 0, entry, shape, material, first_id: 7, taken: &[] };
        fill(&Check { text: &text }, &request)
    }

    #[test]
    fn a_fill_has_its_mass_lies_inside_and_touches_nothing() {
        let shape = "cylinder:0,0,0,0,0,0.2,0.1";
        let found = filled(shape, 1.0, 0).unwrap();
        let mass: f64 = found.iter().map(|p| 1000.0 * volume(p.radius)).sum();
        assert!((mass - 1.0).abs() < 1000.0 * volume(0.01), "{mass} kg");
        for (i, p) in found.iter().enumerate() {
            assert!((0.005..=0.01).contains(&p.radius) && p.position.xy().norm() + p.radius <= 0.1 + 1e-12);
            assert!(found[..i].iter().all(|q| (q.position - p.position).norm() >= q.radius + p.radius));
        }
        assert_eq!((found[0].id, found.len()), (7, found.last().unwrap().id as usize - 6));
        assert_eq!(found, filled(shape, 1.0, 0).unwrap());
        assert_ne!(found, filled(shape, 1.0, 1).unwrap());
    }

    #[test]
    fn a_shape_that_is_too_small_is_refused() {
        let message = filled("box:0,0,0,0.1,0.1,0.1", 5.0, 0).unwrap_err().to_string();
        assert!(message.contains("kg) fit without touching") && message.contains("[[insert]]"), "{message}");
        assert!(filled("halfspace:0,0,0,0,0,1", 5.0, 0).unwrap_err().to_string().contains("only box"));
    }
}

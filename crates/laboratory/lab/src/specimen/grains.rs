//! What is known of the grains of a sample: sizes, time step, and where they are if they are packed already.

use crate::error::{LabError, Result};
use dem::setup::{Bond, BondKind, BondSprings, Setup};
use geom::{Vec3, sphere};
use scene::{Plan, Scene, SceneSetupError};

/// What is known of the grains of a sample.
#[derive(Debug, Clone)]
pub struct Grains {
    /// Mean diameter of spheres, or of the spheres around clumps [m].
    pub diameter: f64,
    /// Largest of these [m].
    pub largest: f64,
    /// Mean volume of the solid of a grain [m³].
    pub volume: f64,
    /// Mean density [kg/m³].
    pub density: f64,
    /// Volume of the spheres around grains over that of their solid [–].
    pub around: f64,
    /// Time step without bonds [s].
    pub step: f64,
    /// Strain at which bonds reach their strength, times the speed of sound along them [m/s]: the least one; `None` where none can break.
    pub breaking: Option<f64>,
    /// Length of the acceleration of free fall [m/s²].
    pub gravity: f64,
    /// Whether it acts along −z alone.
    pub falls_down: bool,
    /// Whether there are rigid clumps.
    pub clumps: bool,
    /// Lowest and highest corner of grains that are packed already [m], and each of them.
    pub packed: Option<Packed>,
    /// What is doubtful in the sample.
    pub warnings: Vec<String>,
}

/// Grains that are packed already.
#[derive(Debug, Clone)]
pub struct Packed {
    /// Lowest corner [m].
    pub low: Vec3,
    /// Highest corner [m].
    pub high: Vec3,
    /// Centre [m] and radius [m] of each sphere.
    pub spheres: Vec<(Vec3, f64)>,
    /// Volume of the solid, overlaps counted twice [m³].
    pub solid: f64,
    /// Whether all grains are of one cluster.
    pub one_body: bool,
}

impl Grains {
    pub(crate) fn none() -> Grains {
        Grains {
            diameter: 0.0,
            largest: 0.0,
            volume: 0.0,
            density: 0.0,
            around: 1.0,
            step: 0.0,
            breaking: None,
            gravity: 0.0,
            falls_down: false,
            clumps: false,
            packed: None,
            warnings: Vec::new(),
        }
    }

    /// The grains of a scene.
    pub(crate) fn of(scene: &Scene, packed: bool) -> Result<Grains> {
        let Plan { setup, warnings, .. } = scene.plan(Vec::new())?;
        let mut grains = Grains {
            gravity: setup.gravity.norm(),
            falls_down: setup.gravity.z < 0.0 && setup.gravity.x == 0.0 && setup.gravity.y == 0.0,
            clumps: !setup.clumps.placed.is_empty(),
            warnings,
            ..Grains::none()
        };
        let bodies = bodies(&setup);
        let n = bodies.len() as f64;
        let (solid, mass, around) = bodies
            .iter()
            .fold((0.0, 0.0, 0.0), |s, b| (s.0 + b.volume, s.1 + b.mass, s.2 + sphere::volume(b.reach)));
        grains.diameter = bodies.iter().map(|b| 2.0 * b.reach).sum::<f64>() / n;
        grains.largest = bodies.iter().map(|b| 2.0 * b.reach).fold(0.0, f64::max);
        (grains.volume, grains.density, grains.around) = (solid / n, mass / solid, around / solid);
        grains.packed = packed.then(|| Packed::of(&setup, solid));
        grains.step = dem::time_step(&setup).map_err(|error| {
            let source = SceneSetupError::from(error);
            LabError::Setup { place: scene.place_of(&source), source: source.into() }
        })?;
        grains.breaking = grains.breaking_of(&setup.bonds);
        Ok(grains)
    }

    /// The least ε c of bonds.
    pub(crate) fn breaking_of(&self, bonds: &[Bond]) -> Option<f64> {
        bonds.iter().filter_map(|bond| breaking(bond, self.diameter, self.density)).min_by(f64::total_cmp)
    }
}

/// ε c of a bond, with ε = strength/modulus and c = √(modulus/ρ) [m/s]; a bond of given stiffnesses has the modulus of one grain's length.
fn breaking(bond: &Bond, diameter: f64, density: f64) -> Option<f64> {
    let modulus = match bond.kind {
        BondKind::Beam { young, .. } => young,
        BondKind::Parallel { springs: BondSprings::Modulus { modulus, .. }, .. }
        | BondKind::Contact(BondSprings::Modulus { modulus, .. }) => modulus,
        BondKind::Parallel { springs: BondSprings::Given([normal, _]), .. } => normal * diameter,
        BondKind::Contact(BondSprings::Given([normal, _])) => normal / diameter,
    };
    let strength = bond.strength.tension.min(bond.strength.shear);
    (strength > 0.0 && strength.is_finite()).then(|| strength / (modulus * density).sqrt())
}

/// A sphere or a clump.
struct GrainBody {
    reach: f64,
    volume: f64,
    mass: f64,
}

fn bodies(setup: &Setup) -> Vec<GrainBody> {
    let density = |material: u16| setup.materials[material as usize].density;
    let spheres = setup.particles.iter().map(|p| {
        let volume = sphere::volume(p.radius);
        GrainBody { reach: p.radius, volume, mass: volume * density(p.material) }
    });
    let clumps = setup.clumps.placed.iter().map(|body| {
        let shape = &setup.clumps.shapes[body.shape as usize];
        let volume = shape.volume * body.scale.powi(3);
        GrainBody { reach: shape.reach() * body.scale, volume, mass: volume * density(shape.material) }
    });
    spheres.chain(clumps).collect()
}

impl Packed {
    fn of(setup: &Setup, solid: f64) -> Packed {
        let mut spheres: Vec<(Vec3, f64)> = setup.particles.iter().map(|p| (p.position, p.radius)).collect();
        for body in &setup.clumps.placed {
            let shape = &setup.clumps.shapes[body.shape as usize];
            spheres.extend(shape.spheres_at(body.position, &body.orientation, body.scale));
        }
        let corner = |sign: f64| {
            let along =
                |k: usize| spheres.iter().map(|(c, r)| sign * c[k] + r).fold(f64::NEG_INFINITY, f64::max);
            Vec3::new(along(0), along(1), along(2)) * sign
        };
        let clusters: std::collections::BTreeSet<u32> = setup.clusters.iter().map(|c| c.1).collect();
        let one_body = clusters.len() == 1 && setup.clusters.len() == setup.particles.len();
        Packed { low: corner(-1.0), high: corner(1.0), spheres, solid, one_body }
    }

    /// The first gap along x, y or z that is wider than a limit [m]: its axis, and where it begins and ends [m].
    pub(crate) fn gap_above(&self, limit: f64) -> Option<(char, f64, f64)> {
        ['x', 'y', 'z'].into_iter().enumerate().find_map(|(k, axis)| {
            let mut along: Vec<[f64; 2]> = self.spheres.iter().map(|(c, r)| [c[k] - r, c[k] + r]).collect();
            along.sort_by(|a, b| a[0].total_cmp(&b[0]));
            let mut end = along.first()?[1];
            along.into_iter().find_map(|[low, high]| {
                let gap = (low - end > limit).then_some((axis, end, low));
                end = end.max(high);
                gap
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grain_far_from_the_others_leaves_a_gap() {
        let at = |x: f64| (Vec3::new(x, 0.0, 0.0), 0.005);
        let packed = |spheres: Vec<(Vec3, f64)>| Packed {
            low: Vec3::zeros(),
            high: Vec3::zeros(),
            spheres,
            solid: 0.0,
            one_body: false,
        };
        let near = packed(vec![at(0.1), at(0.0), at(0.05)]);
        assert_eq!(near.gap_above(0.05), None);
        let (axis, low, high) = packed(vec![at(1.0), at(0.01), at(0.0)]).gap_above(0.05).unwrap();
        assert!(axis == 'x' && (low - 0.015).abs() < 1e-12 && (high - 0.995).abs() < 1e-12);
    }
}

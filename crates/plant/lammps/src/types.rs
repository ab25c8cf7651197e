//! Atom types: one for each material of grains and each wall of spheres, and one for each size where a law depends on it.

use crate::error::Refusal;
use crate::grain::Meeting;
use crate::law::depends_on_size;
use dem::setup::{ContactLaw, Setup, WallShape};

/// Sizes of one material that get a type each: LAMMPS has coefficients for each pair of types.
const MOST_SIZES: usize = 16;

/// What atoms of a type are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// Particles that move freely.
    Grain,
    /// Spheres of the wall of this index.
    Wall(usize),
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AtomType {
    /// What its atoms are.
    pub kind: Kind,
    /// Index of their material.
    pub material: u16,
    /// Radius of all of them [m], where a law depends on it.
    pub radius: Option<f64>,
    /// Mean radius [m], where a law depends on it and there are more sizes than types.
    pub mean: Option<f64>,
}

impl AtomType {
    /// The radius that laws are written for [m].
    fn size(&self) -> Option<f64> {
        self.radius.or(self.mean)
    }
}

/// All types; LAMMPS numbers them from 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Types(pub Vec<AtomType>);

impl Types {
    /// Types of a setup.
    ///
    /// # Errors
    /// More sizes than types, where a law depends on sizes.
    pub fn of(setup: &Setup) -> Result<Types, Refusal> {
        Types::made(setup, true)
    }

    /// One type for each material, with its mean size where a law depends on it.
    pub fn of_means(setup: &Setup) -> Types {
        let mut types = Types::made(setup, false).unwrap_or(Types(Vec::new()));
        for t in &mut types.0 {
            let of_grains = || setup.particles.iter().filter(|p| p.material == t.material).map(|p| p.radius);
            let radii: Vec<f64> = match (t.kind, &setup.walls[..]) {
                (Kind::Wall(index), walls) => match &walls[index].shape {
                    WallShape::Spheres(spheres) => spheres.iter().map(|s| s.1).collect(),
                    _ => Vec::new(),
                },
                (Kind::Grain, _) => of_grains().collect(),
            };
            t.mean = Some(radii.iter().sum::<f64>() / radii.len().max(1) as f64);
        }
        types
    }

    fn made(setup: &Setup, by_size: bool) -> Result<Types, Refusal> {
        let mut types = Types(Vec::new());
        let sized = |material: u16| {
            let law = |law: &&ContactLaw| law.between.0 == material || law.between.1 == material;
            by_size && setup.contacts.iter().filter(law).any(depends_on_size)
        };
        let sized: Vec<bool> = (0..setup.materials.len()).map(|m| sized(m as u16)).collect();
        for p in &setup.particles {
            types.add(setup, Kind::Grain, p.material, sized[p.material as usize].then_some(p.radius))?;
        }
        for (index, wall) in setup.walls.iter().enumerate() {
            let WallShape::Spheres(spheres) = &wall.shape else { continue };
            for (_, radius) in spheres {
                let radius = sized[wall.material as usize].then_some(*radius);
                types.add(setup, Kind::Wall(index), wall.material, radius)?;
            }
        }
        Ok(types)
    }

    fn add(&mut self, setup: &Setup, kind: Kind, material: u16, radius: Option<f64>) -> Result<(), Refusal> {
        let new = AtomType { kind, material, radius, mean: None };
        // Most atoms are of the type of the one before.
        if self.0.last() == Some(&new) || self.0.contains(&new) {
            return Ok(());
        }
        if self.0.iter().filter(|t| t.kind == kind && t.material == material).count() == MOST_SIZES {
            let name = &setup.materials[material as usize].name;
            return Err(Refusal::new(
                format!("sizes of '{name}'"),
                format!(
                    "rolling, twisting and moduli need a type for each size in LAMMPS, and there are more than {MOST_SIZES}"
                ),
                "give sizes as a list of single diameters, or leave that resistance or modulus out",
            ));
        }
        self.0.push(new);
        Ok(())
    }

    /// Number of the type of an atom, from 1.
    pub fn number(&self, kind: Kind, material: u16, radius: f64) -> usize {
        let is =
            |t: &AtomType| t.kind == kind && t.material == material && t.radius.is_none_or(|r| r == radius);
        self.0.iter().position(is).map_or(0, |index| index + 1)
    }

    /// Types of grains, with their numbers.
    pub fn grains(&self) -> impl Iterator<Item = (usize, &AtomType)> {
        (1..).zip(&self.0).filter(|(_, t)| t.kind == Kind::Grain)
    }

    /// Sizes of two atoms that meet, where their types have one size each.
    pub fn meeting(setup: &Setup, [a, b]: [&AtomType; 2]) -> Option<Meeting> {
        let (r, s) = (a.size()?, b.size()?);
        Some(Meeting::of([r, s], [mass(setup, a), mass(setup, b)]))
    }

    /// A grain of a type at a flat wall.
    pub fn at_plane(setup: &Setup, grain: &AtomType) -> Option<Meeting> {
        grain.size().map(|radius| Meeting::flat(radius, mass(setup, grain)))
    }
}

/// Mass of an atom [kg]; that of a wall counts as infinite.
fn mass(setup: &Setup, t: &AtomType) -> f64 {
    match (t.kind, t.size()) {
        (Kind::Grain, Some(radius)) => dem::mass(radius, setup.materials[t.material as usize].density),
        _ => f64::INFINITY,
    }
}

/// The law between two materials; `None` where they never meet.
pub fn law(setup: &Setup, a: u16, b: u16) -> Option<&ContactLaw> {
    setup.contacts.iter().find(|law| law.between == (a, b) || law.between == (b, a))
}

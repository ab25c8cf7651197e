//! The data file: all atoms at t = 0, grains first, then wall spheres.

use crate::arrival::Arrival;
use crate::bonds::Bonds;
use crate::clumps::{self, Numbers};
use crate::places::{number_of, wrapped};
use crate::types::{Kind, Types};
use dem::setup::{Particle, Setup, WallShape};
use geom::Vec3;
use std::io::{self, Write};

/// How much heavier a wall sphere that moves is than the heaviest grain [–]: m* is that of the grain to rounding.
const HEAVIER: f64 = 1e18;

/// An atom of LAMMPS.
struct Atom {
    number: u64,
    kind: usize,
    radius: f64,
    density: f64,
    position: Vec3,
    velocity: Vec3,
    spin: Vec3,
}

/// Largest number of an atom: LAMMPS of most builds holds it in 32 bits.
pub const MOST_ATOMS: u64 = i32::MAX as u64;

/// Highest number of all atoms.
pub fn highest_number(setup: &Setup) -> u64 {
    let grains = setup.particles.iter().map(|p| number_of(p.id)).max().unwrap_or(0);
    grains + walls(setup) as u64
}

fn walls(setup: &Setup) -> usize {
    let count = |w: &dem::setup::Wall| if let WallShape::Spheres(s) = &w.shape { s.len() } else { 0 };
    setup.walls.iter().map(count).sum()
}

/// Lowest and highest corner of the box [m]: the period, or all spheres with a margin of one diameter.
pub fn bounds(setup: &Setup) -> [Vec3; 2] {
    let grains = setup.particles.iter().map(|p| (p.position, p.radius));
    let spheres = setup.walls.iter().flat_map(|w| match &w.shape {
        WallShape::Spheres(all) => &all[..],
        _ => &[],
    });
    let (mut low, mut high) = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
    for (centre, radius) in grains.chain(spheres.copied()) {
        let margin = Vec3::repeat(3.0 * radius);
        (low, high) = (low.inf(&(centre - margin)), high.sup(&(centre + margin)));
    }
    for axis in 0..3 {
        if let Some((lo, hi)) = setup.periodic[axis] {
            (low[axis], high[axis]) = (lo, hi);
        } else if !low[axis].is_finite() {
            (low[axis], high[axis]) = (0.0, 1.0);
        }
    }
    [low, high]
}

/// Writes the data file.
///
/// # Errors
/// A write that fails.
pub fn write(
    setup: &Setup,
    types: &Types,
    (arrivals, bonds): (&[Arrival], &Bonds),
    out: &mut impl Write,
) -> io::Result<()> {
    let [low, high] = bounds(setup);
    writeln!(out, "Grains and wall spheres of a scene, written by dem-lammps\n")?;
    writeln!(out, "{} atoms\n{} atom types\n", setup.particles.len() + walls(setup), types.0.len().max(1))?;
    if bonds.any() {
        writeln!(out, "{}", bonds.counts())?;
    }
    for (axis, name) in ["x", "y", "z"].iter().enumerate() {
        writeln!(out, "{:?} {:?} {name}lo {name}hi", low[axis], high[axis])?;
    }
    let rigid = clumps::any(setup);
    let images = if rigid { ", periods between it and its position in its clump" } else { "" };
    // Of bonded spheres the number of a molecule comes before the type.
    let (style, molecule) = if bonds.any() { ("bpm/sphere", " 0") } else { ("sphere", "") };
    writeln!(out, "\nAtoms # {style}: number, type, diameter, density, x, y, z{images}\n")?;
    each(setup, types, |a| {
        let (x, [i, j, k]) = wrapped(setup, a.position);
        write!(out, "{}{molecule} {} {:?} {:?}", a.number, a.kind, 2.0 * a.radius, a.density)?;
        write!(out, " {:?} {:?} {:?}", x.x, x.y, x.z)?;
        if rigid { writeln!(out, " {i} {j} {k}") } else { writeln!(out) }
    })?;
    writeln!(out, "\nVelocities # number, vx, vy, vz, wx, wy, wz\n")?;
    each(setup, types, |a| {
        let (v, w) = (a.velocity, a.spin);
        writeln!(out, "{} {:?} {:?} {:?} {:?} {:?} {:?}", a.number, v.x, v.y, v.z, w.x, w.y, w.z)
    })?;
    if rigid {
        let numbers = Numbers::new(setup);
        writeln!(out, "\nMolecules # number, that of its clump\n")?;
        each(setup, types, |a| {
            let id = u32::try_from(a.number - 1).unwrap_or(u32::MAX);
            writeln!(out, "{} {}", a.number, numbers.of(id))
        })?;
    }
    if bonds.any() {
        bonds.write(out)?;
    }
    if arrivals.is_empty() {
        return Ok(());
    }
    let names = "time from which a grain is free [s], step from which it falls; step and change of velocity [m/s] when it leaves, and when it comes";
    writeln!(out, "\nWay # number, {names}\n")?;
    each(setup, types, |a| {
        write!(out, "{}", a.number)?;
        let of = arrivals.binary_search_by_key(&a.number, |arrival| number_of(arrival.id));
        let numbers = of.map_or([0.0; 10], |index| arrivals[index].numbers());
        numbers.iter().try_for_each(|value| write!(out, " {value:?}"))?;
        writeln!(out)
    })
}

/// Calls `put` with each atom.
fn each(setup: &Setup, types: &Types, mut put: impl FnMut(Atom) -> io::Result<()>) -> io::Result<()> {
    let density = |material: u16| setup.materials[material as usize].density;
    for p in &setup.particles {
        put(Atom {
            number: number_of(p.id),
            kind: types.number(Kind::Grain, p.material, p.radius),
            radius: p.radius,
            density: density(p.material),
            position: p.position,
            velocity: p.velocity,
            spin: p.spin,
        })?;
    }
    let mass = |p: &Particle| dem::mass(p.radius, density(p.material));
    let heaviest = setup.particles.iter().map(mass).fold(0.0, f64::max);
    let mut number = setup.particles.iter().map(|p| number_of(p.id)).max().unwrap_or(0);
    for (index, wall) in setup.walls.iter().enumerate() {
        let WallShape::Spheres(spheres) = &wall.shape else { continue };
        for (centre, radius) in spheres {
            number += 1;
            put(Atom {
                number,
                kind: types.number(Kind::Wall(index), wall.material, *radius),
                radius: *radius,
                density: HEAVIER * heaviest / dem::mass(*radius, 1.0),
                position: *centre,
                velocity: Vec3::zeros(),
                spin: Vec3::zeros(),
            })?;
        }
    }
    Ok(())
}

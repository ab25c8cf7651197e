//! Fragments with their mass and size, and what of them passes sieves.
//!
//! ```text
//! d = (6 V/π)^(1/3)                 diameter of a sphere of the volume of its grains, which count whole where they overlap
//! L ≥ I ≥ S                         extents along the principal axes of its centres, radii included; I is what a square sieve sees
//! ```

use super::Bonds;
use crate::{Frame, MeasureError};
use geom::Vec3;
use nalgebra::{Matrix3, SymmetricEigen};
use std::collections::HashMap;
use std::f64::consts::PI;

/// Grains that whole bonds join, directly or through others; a grain without is one by itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// Lowest id of its grains.
    pub id: u64,
    pub grains: usize,
    /// Mass [kg].
    pub mass: f64,
    /// Volume of its grains [m³].
    pub volume: f64,
    /// Centre of mass [m].
    pub centre: Vec3,
    /// L, I, S [m].
    pub extents: [f64; 3],
}

impl Piece {
    /// Diameter of a sphere of its volume [m].
    pub fn diameter(&self) -> f64 {
        (6.0 * self.volume / PI).cbrt()
    }
}

/// The pieces of a frame, by their lowest id; `periods` [m] are the extents of periodic axes, 0 along others.
///
/// # Errors
/// Grains without a density.
pub fn pieces(frame: &Frame, bonds: &Bonds, periods: Vec3) -> Result<Vec<Piece>, MeasureError> {
    let masses = frame.masses()?;
    let rows: HashMap<u64, usize> = frame.id.iter().copied().zip(0..).collect();
    let mut joined = vec![Vec::new(); frame.len()];
    for bond in bonds.rows.iter().filter(|b| b.broken.is_none()) {
        if let [Some(&a), Some(&b)] = bond.grains.map(|id| rows.get(&id)) {
            joined[a].push(b);
            joined[b].push(a);
        }
    }
    let mut order: Vec<usize> = (0..frame.len()).collect();
    order.sort_unstable_by_key(|row| frame.id[*row]);
    let (mut seen, mut found) = (vec![false; frame.len()], Vec::new());
    for first in order {
        if std::mem::replace(&mut seen[first], true) {
            continue;
        }
        // Each grain where it is nearest to the one it is bonded to: a piece may lie across a periodic face.
        let mut members = vec![(first, frame.position[first])];
        let mut next = 0;
        while let Some(&(row, place)) = members.get(next) {
            next += 1;
            for &other in &joined[row] {
                if !std::mem::replace(&mut seen[other], true) {
                    members.push((other, place + nearest(frame.position[other] - place, &periods)));
                }
            }
        }
        found.push(piece(frame, masses, &members));
    }
    Ok(found)
}

/// The shortest of the images of an arm.
fn nearest(arm: Vec3, periods: &Vec3) -> Vec3 {
    arm.zip_map(periods, |x, period| if period > 0.0 { x - period * (x / period).round() } else { x })
}

fn piece(frame: &Frame, masses: &[f64], members: &[(usize, Vec3)]) -> Piece {
    let mass: f64 = members.iter().map(|m| masses[m.0]).sum();
    let volume = members.iter().map(|m| 4.0 / 3.0 * PI * frame.radius[m.0].powi(3)).sum();
    let centre = members.iter().map(|m| m.1 * masses[m.0]).sum::<Vec3>() / mass;
    let spread = |m: &(usize, Vec3)| (m.1 - centre) * (m.1 - centre).transpose() * masses[m.0];
    let axes = SymmetricEigen::new(members.iter().map(spread).sum::<Matrix3<f64>>()).eigenvectors;
    let extent = |axis: Vec3| {
        let ends = members.iter().map(|(row, place)| ((place - centre).dot(&axis), frame.radius[*row]));
        let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (at, radius)| {
            (low.min(at - radius), high.max(at + radius))
        });
        high - low
    };
    let mut extents = [0, 1, 2].map(|axis| extent(axes.column(axis).into_owned()));
    extents.sort_by(|a, b| b.total_cmp(a));
    let id = members.iter().map(|m| frame.id[m.0]).min().unwrap_or(0);
    Piece { id, grains: members.len(), mass, volume, centre, extents }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bonds::{Bond, Break};

    /// A bar of four grains across a periodic face, and one grain alone.
    #[test]
    fn pieces_have_the_mass_and_the_extents_of_their_grains() {
        let x = [0.96, 0.98, 1.0, 0.02, 0.5];
        let frame = Frame {
            id: vec![4, 3, 2, 1, 9],
            position: x.map(|x| Vec3::new(x, 0.1, 0.0)).to_vec(),
            radius: vec![0.01; 5],
            mass: vec![2.0; 5],
            ..Frame::default()
        };
        let bond = |a, b, broken| Bond {
            grains: [a, b],
            force: Vec3::zeros(),
            stress: [0.0; 2],
            broken,
            by: Break::Unknown,
        };
        let rows = vec![bond(1, 2, None), bond(2, 3, None), bond(3, 4, None), bond(4, 9, Some(0.1))];
        let found = pieces(&frame, &Bonds { time: 0.0, rows }, Vec3::new(1.0, 0.0, 0.0)).expect("densities");
        assert_eq!(
            found.iter().map(|p| (p.id, p.grains, p.mass)).collect::<Vec<_>>(),
            [(1, 4, 8.0), (9, 1, 2.0)]
        );
        let [length, middle, short] = found[0].extents;
        assert!(
            (length - 0.08).abs() < 1e-12 && (middle - 0.02).abs() < 1e-12 && (short - 0.02).abs() < 1e-12
        );
        assert!((found[0].diameter() - 0.02 * 4f64.cbrt()).abs() < 1e-12);
    }
}

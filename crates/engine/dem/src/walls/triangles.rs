//! The triangles of a wall: which are near a particle, and which of its nearest points on them are contacts.

use super::{WallBody, beside};
use geom::{Boxes, Vec3};
use laws::contact::seams::{self, Member, Nearest};
use std::collections::HashSet;

/// Triangles of a wall, as at t = 0.
#[derive(Debug, Clone)]
pub struct Triangles {
    /// [m].
    pub corners: Vec<[Vec3; 3]>,
    /// A tree of their boxes.
    pub boxes: Boxes,
    /// Whether each lies on one before it, and so is never touched; empty where none does.
    pub doubled: Vec<bool>,
}

impl Triangles {
    /// Sorts them into their tree.
    pub fn new(corners: Vec<[Vec3; 3]>) -> Triangles {
        let around = |t: &[Vec3; 3]| [t[0].inf(&t[1]).inf(&t[2]), t[0].sup(&t[1]).sup(&t[2])];
        let boxes: Vec<[Vec3; 2]> = corners.iter().map(around).collect();
        Triangles { boxes: Boxes::new(&boxes), doubled: doubled(&corners), corners }
    }

    /// Those within `reach` [m] of `p`, in order.
    pub fn near(&self, p: Vec3, reach: f64, found: impl FnMut(u32)) {
        let mut near = Vec::new();
        self.boxes.near(p, reach, |k| near.push(k));
        if !self.doubled.is_empty() {
            near.retain(|k| !self.doubled[*k as usize]);
        }
        near.sort_unstable();
        let close = |k: &u32| Nearest::of(self.corners[*k as usize], p).way.norm_squared() < reach * reach;
        near.into_iter().filter(close).for_each(found);
    }
}

/// Which triangles have the corners of one before them, in any order, as those of drawings whose faces are there from both sides: one that is touched in
/// the other's place would begin without its contact history. Empty where none has.
fn doubled(corners: &[[Vec3; 3]]) -> Vec<bool> {
    let mut seen = HashSet::with_capacity(corners.len());
    // + 0 makes one zero of two.
    let bits = |v: &Vec3| [v.x, v.y, v.z].map(|x| (x + 0.0).to_bits());
    let again = |triangle: &[Vec3; 3]| {
        let mut key = triangle.each_ref().map(bits);
        key.sort_unstable();
        !seen.insert(key)
    };
    let doubled: Vec<bool> = corners.iter().map(again).collect();
    if doubled.contains(&true) { doubled } else { Vec::new() }
}

/// Memory for the triangles near one particle, kept from one to the next.
#[derive(Default)]
pub struct Nearby {
    /// Its nearest points on those of a wall.
    pub near: Vec<Nearest>,
    /// With those of the walls beside it.
    pub together: Vec<Nearest>,
    /// For either.
    pub order: Vec<Member>,
}

impl Nearby {
    /// The nearest points of some triangles of wall number `own`, each with the centre of the particle as its image sees it [m]; which of them are contacts is known.
    /// `image` as in [`beside::count`].
    pub fn find(
        &mut self,
        triangles: impl Iterator<Item = ([Vec3; 3], Vec3)>,
        (walls, own): (&[WallBody], usize),
        image: impl Fn(usize) -> (u32, Vec3),
        (radius, reach): (f64, f64),
    ) -> &[Nearest] {
        self.near.clear();
        self.near.extend(triangles.map(|(corners, centre)| Nearest::of(corners, centre)));
        if walls.get(own).is_some_and(|wall| !wall.beside.is_empty()) {
            beside::count(walls, own, self, image, (radius, reach));
        } else {
            self.order.resize(self.near.len(), Member::default());
            seams::count(&mut self.near, &mut self.order, radius, reach);
        }
        &self.near
    }
}

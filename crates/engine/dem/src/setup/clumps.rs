//! What the rest of the engine asks of the clumps of a setup.

use crate::setup::clump_shape::ClumpShape;
use crate::setup::{ClumpScales, Clumps, EntryClump, Setup};
use laws::effects::{Compliance, Material};

/// Spheres or rigid clumps of one size, and how easily they give way, for the critical step.
#[derive(Debug, Clone, PartialEq)]
pub struct SizeClass {
    /// Name of the shape of clumps; `None`: spheres.
    pub shape: Option<String>,
    /// Index of the material.
    pub material: u16,
    /// Of the largest sphere that touches [m].
    pub radius: f64,
    /// 1/m of the whole [1/kg].
    pub inverse_mass: f64,
    /// 1/m of the sphere that yields as easily to normal forces [1/kg].
    pub normal: f64,
    /// The same for tangential forces [1/kg].
    pub tangential: f64,
}

/// Beyond any [–]; a number of single precision, also times 1/m.
const AT_ONCE: f64 = 1e12;

impl Setup {
    /// Of two materials, where so many times the contacts of a close packing push at once.
    pub(crate) fn compliance(&self, a: u16, b: u16, crowd: f64) -> Compliance {
        let clumps = self.clumps.yielding(&self.materials);
        let own = clumps.iter().filter(|c| c.material == a || c.material == b);
        let clumps = crowd * own.map(|c| c.normal.max(c.tangential) / c.inverse_mass).fold(1.0, f64::max);
        let is_bonded = |m: u16| self.bonds.iter().any(|bond| bond.between.0 == m || bond.between.1 == m);
        Compliance { clumps, springs: if is_bonded(a) || is_bonded(b) { AT_ONCE } else { clumps } }
    }
}

impl Clumps {
    /// Number of members of all clumps at t = 0.
    pub fn members(&self) -> usize {
        self.placed.iter().filter_map(|b| self.shapes.get(b.shape as usize)).map(|s| s.spheres.len()).sum()
    }

    /// Radius of every member at t = 0 [m], or of every shape that inlets bring where there is none.
    pub(crate) fn member_radii(&self) -> Vec<f64> {
        let of = |(shape, scale): (u32, f64)| {
            let spheres = self.shapes.get(shape as usize).map_or(&[][..], |s| &s.spheres[..]);
            spheres.iter().map(move |s| s.1 * scale)
        };
        if self.placed.is_empty() {
            return self.entries.iter().map(|e| (e.shape, e.least)).flat_map(of).collect();
        }
        self.placed.iter().map(|b| (b.shape, b.scale)).flat_map(of).collect()
    }

    /// Material, smallest and largest radius [m] of the members of all clumps, those that inlets bring included.
    pub(crate) fn radii(&self) -> impl Iterator<Item = (u16, f64, f64)> + '_ {
        self.scales().map(|(shape, scales)| {
            let (least, most) = shape.radii();
            (shape.material, least * scales.least, most * scales.most)
        })
    }

    /// Compliance of the clumps of each shape, at the smallest and the largest scale.
    pub(crate) fn yielding(&self, materials: &[Material]) -> Vec<SizeClass> {
        let mut range: Vec<Option<(f64, f64)>> = vec![None; self.shapes.len()];
        for ClumpScales { shape, least, most } in self.all_scales() {
            if let Some(range) = range.get_mut(shape as usize) {
                widen(range, least, most);
            }
        }
        let mut list = Vec::new();
        for (shape, (low, high)) in self.shapes.iter().zip(range).filter_map(|(s, r)| Some((s, r?))) {
            let (normal, tangential) = shape.yielding();
            let density = materials[shape.material as usize].density;
            for s in if low == high { vec![low] } else { vec![low, high] } {
                let share = 1.0 / (s * s * s * density);
                list.push(SizeClass {
                    shape: Some(shape.name.clone()),
                    material: shape.material,
                    radius: shape.radii().1 * s,
                    inverse_mass: 1.0 / shape.mass(s, density),
                    normal: normal * share,
                    tangential: tangential * share,
                });
            }
        }
        list
    }

    /// Smallest and largest scale of each clump of a shape, and of those that inlets bring.
    pub fn scales_of(&self, shape: u32) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.all_scales().filter(move |s| s.shape == shape).map(|s| (s.least, s.most))
    }

    /// The shapes of all clumps, those that inlets bring included, with their scales.
    pub(crate) fn scales(&self) -> impl Iterator<Item = (&ClumpShape, ClumpScales)> + '_ {
        self.all_scales().filter_map(|scales| Some((self.shapes.get(scales.shape as usize)?, scales)))
    }

    /// Scales of all clumps, those that inlets bring included.
    fn all_scales(&self) -> impl Iterator<Item = ClumpScales> + '_ {
        let placed =
            self.placed.iter().map(|b| ClumpScales { shape: b.shape, least: b.scale, most: b.scale });
        placed.chain(self.entries.iter().copied())
    }
}

/// Makes a range wide enough for these.
pub(crate) fn widen(range: &mut Option<(f64, f64)>, low: f64, high: f64) {
    *range = Some(range.map_or((low, high), |(l, h)| (l.min(low), h.max(high))));
}

/// Number of spheres of a clump.
pub(crate) fn members(clump: &EntryClump, setup: &Setup) -> u32 {
    setup.clumps.shapes.get(clump.shape as usize).map_or(1, |s| s.spheres.len() as u32)
}

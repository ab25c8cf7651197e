//! What the clumps of a setup are, seen from the rest of the engine.

use crate::effects::{Compliance, Material};
use crate::setup::clump_shape::ClumpShape;
use crate::setup::{Clumps, EntryClump, Setup};

/// How easily a rigid clump gives way, for the critical step.
#[derive(Debug, Clone, PartialEq)]
pub struct ClumpCompliance {
    /// Name of the shape.
    pub name: String,
    /// Its material.
    pub material: u16,
    /// Largest radius of its members [m].
    pub radius: f64,
    /// 1/m of the body [1/kg].
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
    pub(crate) fn ease(&self, a: u16, b: u16, crowd: f64) -> Compliance {
        let clumps = self.clumps.yielding(&self.materials);
        let own = clumps.iter().filter(|c| c.material == a || c.material == b);
        let bodies = crowd * own.map(|c| c.normal.max(c.tangential) / c.inverse_mass).fold(1.0, f64::max);
        let is_bonded = |m: u16| self.bonds.iter().any(|bond| bond.between.0 == m || bond.between.1 == m);
        Compliance { bodies, springs: if is_bonded(a) || is_bonded(b) { AT_ONCE } else { bodies } }
    }
}

impl Clumps {
    /// Number of members of all bodies at t = 0.
    pub fn members(&self) -> usize {
        self.bodies.iter().filter_map(|b| self.shapes.get(b.shape as usize)).map(|s| s.spheres.len()).sum()
    }

    /// Radius of every member at t = 0 [m], or of every shape that inlets bring where there is none.
    pub(crate) fn member_radii(&self) -> Vec<f64> {
        let of = |(shape, scale): (u32, f64)| {
            let spheres = self.shapes.get(shape as usize).map_or(&[][..], |s| &s.spheres[..]);
            spheres.iter().map(move |s| s.1 * scale)
        };
        if self.bodies.is_empty() {
            return self.entries.iter().map(|e| (e.0, e.1)).flat_map(of).collect();
        }
        self.bodies.iter().map(|b| (b.shape, b.scale)).flat_map(of).collect()
    }

    /// Material, smallest and largest radius [m] of the members of all bodies, those that inlets bring included.
    pub(crate) fn radii(&self) -> impl Iterator<Item = (u16, f64, f64)> + '_ {
        self.scales().map(|(shape, low, high)| {
            let (least, most) = shape.radii();
            (shape.material, least * low, most * high)
        })
    }

    /// How easily bodies of each shape give way, at the smallest and the largest scale.
    pub(crate) fn yielding(&self, materials: &[Material]) -> Vec<ClumpCompliance> {
        let mut range: Vec<Option<(f64, f64)>> = vec![None; self.shapes.len()];
        let own = self.bodies.iter().map(|b| (b.shape, b.scale, b.scale));
        for (shape, low, high) in own.chain(self.entries.iter().copied()) {
            if let Some(range) = range.get_mut(shape as usize) {
                *range = Some(range.map_or((low, high), |(l, h)| (l.min(low), h.max(high))));
            }
        }
        let mut list = Vec::new();
        for (shape, (low, high)) in self.shapes.iter().zip(range).filter_map(|(s, r)| Some((s, r?))) {
            let (normal, tangential) = shape.yielding();
            let density = materials[shape.material as usize].density;
            for s in if low == high { vec![low] } else { vec![low, high] } {
                let share = 1.0 / (s * s * s * density);
                list.push(ClumpCompliance {
                    name: shape.name.clone(),
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

    /// Smallest and largest scale of each body of a shape, and of those that inlets bring.
    pub fn scales_of(&self, shape: u32) -> impl Iterator<Item = (f64, f64)> + '_ {
        let own = self.bodies.iter().map(|b| (b.shape, b.scale, b.scale));
        own.chain(self.entries.iter().copied())
            .filter(move |s| s.0 == shape)
            .map(|(_, low, high)| (low, high))
    }

    /// Shape, smallest and largest scale of all bodies, those that inlets bring included.
    pub(crate) fn scales(&self) -> impl Iterator<Item = (&ClumpShape, f64, f64)> + '_ {
        let own = self.bodies.iter().map(|b| (b.shape, b.scale, b.scale));
        let all = own.chain(self.entries.iter().copied());
        all.filter_map(|(shape, low, high)| Some((self.shapes.get(shape as usize)?, low, high)))
    }
}

/// Number of spheres of a clump.
pub(crate) fn members(clump: &EntryClump, setup: &Setup) -> u32 {
    setup.clumps.shapes.get(clump.shape as usize).map_or(1, |s| s.spheres.len() as u32)
}

//! What a scene can mean, but hardly does: told before the run, not refused.

use crate::particle_file::ParticleFile;
use crate::plan::Draft;
use dem::effects::{Slot, active};
use dem::setup::{ContactLaw, WallShape};
use geom::{Shown, Vec3, grid};
use std::ops::Range;

/// Densities of what grains are made of [kg/m³]: from foam to beyond osmium.
const DENSITIES: [f64; 2] = [10.0, 30_000.0];
/// Young's moduli: softer is jelly, stiffer than diamond is nothing [Pa].
pub(crate) const SOFT: f64 = 1e3;
const STIFF: f64 = 2e12;
/// Radii of grains [m].
const RADII: [f64; 2] = [1e-7, 1.0];
/// Share of the smaller radius that two may overlap by at the start before it is told.
const DEEP: f64 = 0.01;

/// What was read that may have to be told.
#[derive(Default)]
pub(crate) struct Read {
    /// Particles of files that people wrote.
    pub placed: usize,
    /// Files that give their particles spins.
    pub spinning: Vec<String>,
    /// Particles of runs, by index: they lie as the engine left them.
    pub settled: Vec<Range<usize>>,
}

impl Read {
    /// A file whose particles come after `first` others.
    pub(crate) fn file(&mut self, source: &str, file: &ParticleFile, first: usize) {
        // Only runs name their materials.
        if file.materials.is_empty() {
            self.placed += file.particles.len();
        } else {
            self.settled.push(first..first + file.particles.len());
        }
        if file.particles.iter().any(|p| p.spin != Vec3::zeros()) {
            self.spinning.push(source.to_owned());
        }
    }
}

/// Two that overlap at the start: who, by how much [m], over the smaller radius [–].
struct Deep {
    who: String,
    overlap: f64,
    share: f64,
}

impl Draft<'_> {
    /// Tells of everything; `contacts` are the laws in force.
    pub(crate) fn doubts(&mut self, contacts: &[ContactLaw]) {
        self.units();
        self.sizes_on_earth();
        self.lost_spins(contacts);
        let most = self.model().guards.overlap.unwrap_or(dem::setup::Guards::default().overlap);
        // What is deeper is refused.
        let deep = self.deepest().filter(|deep| deep.share > DEEP && deep.share <= most);
        self.notes.extend(deep.map(|Deep { who, overlap, share }| {
            format!(
                "{who} overlap by {overlap:.3e} m at the start, {:.1} % of the smaller radius, and spring apart where nothing presses on them: move them apart, make \
                 them smaller, let [[fill]] place them, or let them settle in a run of its own with much damping",
                100.0 * share
            )
        }));
    }

    fn units(&mut self) {
        let mut tell = |key: &str, value: String, why: &str, cure: &str| {
            self.notes.push(self.check.wrong(key, value, why, cure).to_string());
        };
        for (i, m) in self.scene.model.material.iter().enumerate() {
            let key = format!("material.{i}.density");
            let value = |d: f64| format!("{} kg/m³", Shown(d));
            match m.density {
                Some(d) if d < DENSITIES[0] => {
                    let cure = format!("if g/cm³ are meant, write {}", Shown(1e3 * d));
                    tell(&key, value(d), "is lighter than any grain", &cure);
                }
                Some(d) if d > DENSITIES[1] => {
                    let cure = format!("if g/m³ are meant, write {}", Shown(1e-3 * d));
                    tell(&key, value(d), "is heavier than any metal", &cure);
                }
                _ => {}
            }
            let (key, value) = (format!("material.{i}.young"), format!("{} Pa", Shown(m.young)));
            if m.young < SOFT {
                tell(&key, value, "is softer than any grain", "give it in Pa: 1 MPa is 1e6, 1 GPa is 1e9");
            } else if m.young > STIFF {
                tell(&key, value, "is stiffer than diamond", "give it in Pa: 1 GPa is 1e9");
            }
        }
    }

    fn sizes_on_earth(&mut self) {
        let Some(sizes) = self.sizes() else { return };
        let (low, high) = (sizes.smallest < RADII[0], sizes.largest > RADII[1]);
        let ends = [
            (low, sizes.smallest, "smaller than 1e-7 m", "0.1 mm is a radius of 5e-5"),
            (high, sizes.largest, "larger than 1 m", "10 mm are 0.01"),
        ];
        for (_, radius, what, cure) in ends.into_iter().filter(|end| end.0) {
            let who = self.particles.iter().find(|p| p.radius == radius);
            let who = who.map_or("grains".to_owned(), |p| format!("particle {}", p.id));
            let name = &self.scene.text.name;
            self.notes.push(format!(
                "{name}: {who}: radius = {} m: {what}; lengths are in metres: {cure}",
                Shown(radius)
            ));
        }
    }

    /// Spins that nothing turns are not kept.
    fn lost_spins(&mut self, contacts: &[ContactLaw]) {
        let turns = !self.scene.model.bond.is_empty()
            || contacts.iter().any(|c| active(c).any(|d| d.slot == Slot::Sliding && !(d.idle)(c)));
        if !turns && !self.read.spinning.is_empty() {
            let files = self.read.spinning.join(", ");
            self.notes.push(format!(
                "{files}: the spins (wx, wy, wz) are not kept: no contact has sliding_friction, so that nothing turns; add it, or take \
                 them out"
            ));
        }
    }

    /// The deepest overlap of what files and `[[body]]` place, over the smaller radius: of pairs, and with planes. Members of one clump, and
    /// what a run left, do not count among themselves.
    fn deepest(&self) -> Option<Deep> {
        let clumps = self.clumps.bodies.len();
        let by_hand = self.read.placed > 0 || clumps > 0;
        let spheres = if by_hand { self.taken() } else { Vec::new() };
        let places: Vec<Vec3> = spheres.iter().map(|s| s.0).collect();
        let (low, high) = grid::bounds(&places);
        let sound = spheres.iter().all(|s| s.1 > 0.0 && s.1.is_finite());
        if spheres.is_empty() || !sound || !(high - low).iter().all(|extent| extent.is_finite()) {
            return None;
        }
        let owners = self.owners();
        let planes = self.in_planes(&spheres, &owners);
        pairs(&spheres, &places, &owners).into_iter().chain(planes).max_by(|a, b| a.share.total_cmp(&b.share))
    }

    /// Id of each sphere of [`Draft::taken`], and whose it is: spheres of one owner are not looked at together.
    fn owners(&self) -> Vec<(u32, u32)> {
        // All that runs left is of owner 0.
        let mut owners: Vec<(u32, u32)> = (1..).zip(&self.particles).map(|(n, p)| (p.id, n)).collect();
        let settled = self.read.settled.iter().flat_map(|range| range.clone());
        settled.for_each(|n| owners[n].1 = 0);
        for (owner, b) in (owners.len() as u32 + 1..).zip(&self.clumps.bodies) {
            let members = self.clumps.shapes[b.shape as usize].spheres.len() as u32;
            owners.extend((0..members).map(|k| (b.id.wrapping_add(k), owner)));
        }
        owners
    }

    fn in_planes(&self, spheres: &[(Vec3, f64)], owners: &[(u32, u32)]) -> Option<Deep> {
        let mut worst: Option<Deep> = None;
        for wall in &self.walls {
            let WallShape::Plane(plane) = &wall.shape else { continue };
            for ((centre, radius), (id, _)) in spheres.iter().zip(owners) {
                let overlap = radius - plane.signed_distance(centre);
                let share = overlap / radius;
                if share > worst.as_ref().map_or(DEEP, |w| w.share) {
                    let who = format!("particle {id} and wall '{}'", wall.name);
                    worst = Some(Deep { who, overlap, share });
                }
            }
        }
        worst
    }
}

/// The deepest pair. Each is found from its larger sphere, so that a boulder is not looked for from every grain of sand.
fn pairs(spheres: &[(Vec3, f64)], places: &[Vec3], owners: &[(u32, u32)]) -> Option<Deep> {
    let mean = spheres.iter().map(|s| s.1).sum::<f64>() / spheres.len() as f64;
    let cells = grid::Grid::new(places, 2.0 * mean);
    let order = cells.order();
    let (mut worst, mut found) = (DEEP, None);
    for (i, (centre, radius)) in spheres.iter().enumerate() {
        for j in cells.runs_near(*centre, 2.0 * radius).flat_map(|run| &order[run]).map(|&j| j as usize) {
            let (other, least) = &spheres[j];
            if (*least, j) >= (*radius, i) || owners[i].1 == owners[j].1 {
                continue;
            }
            let overlap = radius + least - (centre - other).norm();
            if overlap > worst * least {
                (worst, found) = (overlap / least, Some((j, i, overlap)));
            }
        }
    }
    found.map(|(j, i, overlap)| {
        let who = format!("particles {} and {}", owners[i].0.min(owners[j].0), owners[i].0.max(owners[j].0));
        Deep { who, overlap, share: worst }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_deepest_pair_is_found_from_its_larger_sphere() {
        let spheres: Vec<(Vec3, f64)> = [(0.0, 1.0), (1.95, 1.0), (-1.05, 0.1), (5.0, 1.0)]
            .map(|(x, r)| (Vec3::new(x, 0.0, 0.0), r))
            .to_vec();
        let places: Vec<Vec3> = spheres.iter().map(|s| s.0).collect();
        let deep = |owners: &[(u32, u32)]| pairs(&spheres, &places, owners);
        let found = deep(&[(7, 1), (3, 2), (9, 3), (4, 4)]).unwrap();
        assert_eq!(found.who, "particles 7 and 9");
        assert!((found.overlap - 0.05).abs() < 1e-12 && (found.share - 0.5).abs() < 1e-9);
        let found = deep(&[(7, 1), (3, 2), (9, 1), (4, 4)]).unwrap();
        assert_eq!(found.who, "particles 3 and 7");
        assert!(deep(&[(7, 0), (3, 0), (9, 0), (4, 0)]).is_none());
    }
}

//! Warnings of a plan: overlaps at the start, spins that nothing turns, and implausible values ([`crate::plan::warnings::implausible`]). The scene runs with them.

pub(in crate::plan) mod impact;
pub(in crate::plan) mod implausible;

use crate::keys::Face;
use crate::plan::builder::PlanBuilder;
use dem::effects::{Slot, active};
use dem::setup::{ContactLaw, Particle, WallShape};
use geom::{Shown, Vec3, counted_as, grid};

/// Overlap at the start, over the smaller radius, above which a warning is given [–].
const DEEP: f64 = 0.01;

/// Two that overlap at the start.
struct DeepOverlap {
    /// Their names.
    pair: String,
    /// [m].
    overlap: f64,
    /// Overlap over the smaller radius [–].
    share: f64,
}

impl PlanBuilder<'_> {
    /// Adds all warnings; `contacts` are those in force.
    pub(in crate::plan) fn warn(&mut self, contacts: &[ContactLaw]) {
        self.implausible();
        self.lost_spins(contacts);
        self.adhesive_walls(contacts);
        self.forces_of_servos();
        self.late();
        self.bonds_to_fixed();
        self.beyond_open_sides();
        let most = self.overlap_limit();
        // Deeper overlaps are refused.
        let deep = self.deepest().filter(|deep| deep.share > DEEP && deep.share <= most);
        self.warnings.extend(deep.map(|DeepOverlap { pair, overlap, share }| {
            format!(
                "{pair} overlap by {overlap:.3e} m at the start, {:.1} % of the smaller radius, and spring apart where nothing presses on them: move them apart, make \
                 them smaller, let [[fill]] place them, or let them settle in a run of its own with much damping",
                100.0 * share
            )
        }));
    }

    /// The faces of a box do not end at its corners: grains beyond its open side are between them, too.
    fn beyond_open_sides(&mut self) {
        for (i, entry) in self.keys().wall.iter().enumerate() {
            let (Some(corners), Some(faces)) = (entry.cuboid, &entry.faces) else { continue };
            let open = Face::ALL.iter().copied().filter(|face| !faces.contains(face));
            let found = open.map(|face| (face, self.beyond(&corners, face))).find(|(_, count)| *count > 0);
            let Some((face, count)) = found else { continue };
            let name = entry.name.clone().unwrap_or_else(|| format!("wall.{i}"));
            let (grains, side) = (counted_as(count, "grain", ["starts", "start"]), face.name());
            let at = Shown(face.coordinate(&corners));
            self.warnings.push(format!(
                "wall '{name}': {grains} beyond the open side {side} of the box, at {at} m, where its other faces go on as endless planes: none can leave over \
                 the rim; give walls that end as mesh = \"…\", or make the box as large as the room of the grains"
            ));
        }
    }

    /// How many grains start beyond a face of a box.
    fn beyond(&self, corners: &[f64; 6], face: Face) -> usize {
        let plane = face.plane(corners);
        let spheres = self.particles.iter().map(|p| &p.position);
        let all = spheres.chain(self.clumps.placed.iter().map(|b| &b.position));
        all.filter(|p| plane.signed_distance(p) < 0.0).count()
    }

    /// The force of a servo is always written.
    fn forces_of_servos(&mut self) {
        let servo = self.walls.iter().find(|wall| wall.servo.is_some());
        let Some(wall) = servo.filter(|_| self.keys().output.wall_forces == Some(false)) else { return };
        let why = format!(
            "changes nothing: wall '{}' has a servo, and with one the forces on all walls are written",
            wall.name
        );
        let warning = self.check.wrong("output.wall_forces", "false", &why, "take it out").to_string();
        self.warnings.push(warning);
    }

    /// Fixed grains are walls: what a bond would hold to them falls.
    fn bonds_to_fixed(&mut self) {
        let bonds = crate::plan::laws::bonds::resolve(&self.check, &self.keys().bond, &self.materials)
            .unwrap_or_default();
        let fixed = self.walls.iter().filter(|wall| wall.name.starts_with("particles."));
        let spheres: Vec<(Vec3, f64, u16, &str)> = fixed
            .filter_map(|wall| match &wall.shape {
                WallShape::Spheres(all) => {
                    Some(all.iter().map(|s| (s.0, s.1, wall.material, wall.name.as_str())))
                }
                _ => None,
            })
            .flatten()
            .collect();
        if bonds.is_empty() || spheres.is_empty() {
            return;
        }
        let places: Vec<Vec3> = spheres.iter().map(|s| s.0).collect();
        let largest =
            spheres.iter().map(|s| s.1).chain(self.particles.iter().map(|p| p.radius)).fold(0.0, f64::max);
        let grid = grid::Grid::new(&places, 2.0 * largest);
        let joined = |p: &Particle, s: &(Vec3, f64, u16, &str)| {
            let gap = (s.0 - p.position).norm() - s.1 - p.radius;
            let of = (p.material.min(s.2), p.material.max(s.2));
            bonds.iter().any(|bond| bond.between == of && gap <= bond.gap)
        };
        let reach = |p: &Particle| p.radius + largest + bonds.iter().map(|b| b.gap).fold(0.0, f64::max);
        let near = |p: &Particle| {
            grid.within(&places, p.position, reach(p)).find(|k| joined(p, &spheres[*k as usize]))
        };
        let found = self.particles.iter().find_map(|p| Some((p.id, spheres[near(p)? as usize].3)));
        if let Some((id, wall)) = found {
            let warning = format!(
                "grain {id} lies beside a grain of {wall} at the distance of a [[bond]], but fixed grains are walls, to which no bond holds: take \
                 'fixed' out, and make these grains heavy, or press them between two walls"
            );
            self.warnings.push(warning);
        }
    }

    /// What would begin when the run has ended.
    fn late(&mut self) {
        let keys = &self.scene.keys;
        let Some(end) = keys.time.until else { return };
        let inserts = keys.insert.iter().enumerate().map(|(k, i)| (format!("insert.{k}.from"), i.from));
        let bonds = keys.bond.iter().enumerate().map(|(k, b)| (format!("bond.{k}.at"), b.at));
        let why = format!("is not before the end of the run at {end} s: nothing comes of it");
        let cure = "give an earlier time, or a later time.until";
        let late = inserts.chain(bonds).filter(|(_, at)| *at > 0.0 && *at >= end);
        let late = late.map(|(key, at)| self.check.wrong(&key, format!("{at} s"), &why, cure).to_string());
        let late: Vec<String> = late.collect();
        self.warnings.extend(late);
    }

    /// Spins that nothing turns are not kept.
    fn lost_spins(&mut self, contacts: &[ContactLaw]) {
        let turns = !self.scene.keys.bond.is_empty()
            || contacts.iter().any(|c| active(c).any(|d| d.slot == Slot::Sliding && !(d.idle)(c)));
        if !turns && !self.read.spinning.is_empty() {
            let files = self.read.spinning.join(", ");
            self.warnings.push(format!(
                "{files}: the spins (wx, wy, wz) are not kept: no contact has sliding_friction, so that nothing turns; add it, or take \
                 them out"
            ));
        }
    }

    /// The deepest overlap of what files and `[[body]]` place, over the smaller radius: of pairs, and with planes. Members of one clump
    /// are not compared with each other, nor are particles of runs.
    fn deepest(&self) -> Option<DeepOverlap> {
        let of_runs: usize = self.read.settled_clumps.iter().map(|range| range.len()).sum();
        let by_hand = self.read.placed > 0 || self.clumps.placed.len() > of_runs;
        let spheres = if by_hand { self.spheres() } else { Vec::new() };
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

    /// Id of each sphere of [`PlanBuilder::spheres`], and its owner: spheres of one owner are not compared.
    fn owners(&self) -> Vec<(u32, u32)> {
        // All that runs left is of owner 0.
        let mut owners: Vec<(u32, u32)> = (1..).zip(&self.particles).map(|(n, p)| (p.id, n)).collect();
        let settled = self.read.settled.iter().flat_map(|range| range.clone());
        settled.for_each(|n| owners[n].1 = 0);
        for (n, b) in self.clumps.placed.iter().enumerate() {
            let members = self.clumps.shapes[b.shape as usize].spheres.len() as u32;
            let settled = self.read.settled_clumps.iter().any(|range| range.contains(&n));
            let owner = if settled { 0 } else { (self.particles.len() + n) as u32 + 1 };
            owners.extend((0..members).map(|k| (b.id.wrapping_add(k), owner)));
        }
        owners
    }

    fn in_planes(&self, spheres: &[(Vec3, f64)], owners: &[(u32, u32)]) -> Option<DeepOverlap> {
        let mut worst: Option<DeepOverlap> = None;
        for wall in &self.walls {
            let WallShape::Plane(plane) = &wall.shape else { continue };
            for ((centre, radius), (id, _)) in spheres.iter().zip(owners) {
                let overlap = radius - plane.signed_distance(centre);
                let share = overlap / radius;
                if share > worst.as_ref().map_or(DEEP, |w| w.share) {
                    let pair = format!("particle {id} and wall '{}'", wall.name);
                    worst = Some(DeepOverlap { pair, overlap, share });
                }
            }
        }
        worst
    }
}

/// The deepest pair. Each is found from its larger sphere, so that no small sphere has to search as far as a large one.
fn pairs(spheres: &[(Vec3, f64)], places: &[Vec3], owners: &[(u32, u32)]) -> Option<DeepOverlap> {
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
        let pair = format!("particles {} and {}", owners[i].0.min(owners[j].0), owners[i].0.max(owners[j].0));
        DeepOverlap { pair, overlap, share: worst }
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
        assert_eq!(found.pair, "particles 7 and 9");
        assert!((found.overlap - 0.05).abs() < 1e-12 && (found.share - 0.5).abs() < 1e-9);
        let found = deep(&[(7, 1), (3, 2), (9, 1), (4, 4)]).unwrap();
        assert_eq!(found.pair, "particles 3 and 7");
        assert!(deep(&[(7, 0), (3, 0), (9, 0), (4, 0)]).is_none());
    }
}

//! `[[insert]]`: zones with a prescribed velocity, and what they insert.

pub(in crate::plan) mod ahead;
pub(in crate::plan) mod clear;
pub(in crate::plan) mod feed;
pub(in crate::plan) mod insertion;
pub(in crate::plan) mod section;
pub(in crate::plan) mod total;
pub(in crate::plan) mod windows;

use crate::error::Result;
use crate::keys::{Insert, OneOrRange};
use crate::plan::builder::PlanBuilder;
use crate::plan::grains::grading::Grading;
use crate::plan::grains::sizes::EntryGrains;
use crate::plan::insertions::clear::Met;
use crate::plan::insertions::feed::{Feed, Inserted, InsertedClump};
use crate::plan::insertions::insertion::Insertion;
use dem::setup::{ClumpScales, WallShape, WhenBlocked, Zone};
use geom::{Shape, Shown, counted_as, sphere::volume};
use record::Sizes;

/// Ids that are kept for each insertion; it would have to insert this many to meet those of the next.
const IDS: u32 = 200_000_000;

impl PlanBuilder<'_> {
    pub(in crate::plan) fn insertions(&mut self) -> Result<()> {
        let mut first_id = self.next_id();
        for (i, entry) in self.keys().insert.iter().enumerate() {
            let shape = self.shape(&format!("insert.{i}.shape"), &entry.shape)?;
            self.warn_of_grains_inside(i, entry, &shape);
            let inserted = self.inserted(i, entry)?;
            let feed = Feed::new(&self.check, self.inlets.len() as u32, i, entry, shape, inserted, first_id)?;
            self.in_front_of_walls(&feed, &format!("insert.{i}.shape"), &entry.shape)?;
            self.clear_of_walls(&feed, &format!("insert.{i}.shape"), &entry.shape)?;
            let short = feed.falls_short().map(|(key, value, why)| {
                let later = if entry.until.is_some() { "a later until" } else { "a longer repeat" };
                let cure = &format!("give a higher rate, or {later}");
                self.check.wrong(&format!("insert.{i}.{key}"), value, &why, cure).to_string()
            });
            self.warnings.extend(short);
            first_id = first_id.saturating_add(IDS);
            self.inlets.push(Zone { when_blocked: Some(entry.when_blocked), ..feed.section.zone() });
            self.join(i, feed)?;
        }
        Ok(())
    }

    /// Warns of grains that lie in the shape of an insertion which begins with the run: there is no room for what comes in there.
    fn warn_of_grains_inside(&mut self, i: usize, entry: &Insert, shape: &Shape) {
        if entry.from > 0.0 {
            return;
        }
        let inside = self.particles.iter().filter(|p| shape.contains(&p.position)).count();
        if inside > 0 {
            let grains = counted_as(inside, "grain", ["lies", "lie"]);
            let blocked = match entry.when_blocked {
                WhenBlocked::Wait => "what is inserted waits until its place is free",
                WhenBlocked::Skip => "what is inserted where they are does not come in",
                WhenBlocked::Stop => "the run stops where one is inserted onto them",
            };
            self.warnings.push(format!(
                "insert.{i}.shape: {grains} in it at the start, and {blocked} (when_blocked): move the shape, or start later (from)"
            ));
        }
    }

    /// Puts a feed with all that come through the same place: none of their particles are to touch.
    fn join(&mut self, i: usize, feed: Feed) -> Result<()> {
        let meets = |group: &Insertion| group.feeds.iter().any(|other| other.meets(&feed));
        let at = self.insertions.iter().position(meets).unwrap_or(self.insertions.len());
        let meeting: Vec<Insertion> = self.insertions.extract_if(at.., |group| meets(group)).collect();
        let mut feeds: Vec<Feed> = meeting.into_iter().flat_map(|group| group.feeds).collect();
        if let Some(other) = feeds.iter().find(|other| !other.moves_with(&feed)) {
            let why =
                format!("is another one than that of {}, which comes through the same place", other.key);
            let (key, empty) = (format!("insert.{i}.velocity"), other.is_empty_from());
            let later = match empty.is_finite() {
                true => format!("give insert.{i}.from = {empty:.6} or later"),
                false => format!("end {} (until) before this one begins", other.key),
            };
            let cure = format!("give both the same velocity, move one of their shapes, or {later}");
            let [x, y, z] = self.scene.keys.insert[i].velocity.map(Shown);
            return Err(self.check.wrong(&key, format!("[{x}, {y}, {z}] m/s"), &why, &cure));
        }
        feeds.push(feed);
        self.insertions.insert(at, Insertion::new(feeds));
        Ok(())
    }

    /// What an entry inserts; its sizes and materials are noted for the setup.
    fn inserted(&mut self, i: usize, entry: &Insert) -> Result<Inserted> {
        let Some(name) = &entry.clump else {
            let grading = self.grading(&entry.sized(i))?;
            let OneOrRange { low, high } = grading.range();
            self.will_enter(Sizes { smallest: low / 2.0, largest: high / 2.0 }, true);
            self.entry_materials.extend(grading.materials());
            return Ok(Inserted { grading, clump: None, ids: 1 });
        };
        let index = self.clump(&format!("insert.{i}.clump"), name)?;
        let shape = &self.clumps.shapes[index as usize];
        let scale = entry.scale.unwrap_or(OneOrRange { low: 1.0, high: 1.0 });
        let (least, most) = shape.radii();
        let (reach, density) = (shape.reach(), self.materials[shape.material as usize].density);
        let size = 2.0 * reach;
        let range = OneOrRange { low: scale.low * size, high: scale.high * size };
        let inserted = Inserted {
            grading: Grading::uniform(range, shape.material, shape.mass(1.0, density) / volume(reach)),
            clump: Some(InsertedClump { shape: index, size, scales: scale }),
            ids: shape.spheres.len() as u32,
        };
        self.will_enter(Sizes { smallest: least * scale.low, largest: most * scale.high }, false);
        self.clumps.entries.push(ClumpScales { shape: index, least: scale.low, most: scale.high });
        Ok(inserted)
    }

    /// Refuses an insertion whose particles would meet a wall at rest before they have left its shape.
    fn clear_of_walls(&self, feed: &Feed, key: &str, shape: &str) -> Result<()> {
        for wall in self.walls.iter().filter(|w| !w.moves()) {
            let Some(Met { overlap, at_end }) = clear::meets(feed, wall) else { continue };
            let (name, deep) = (&wall.name, Shown(overlap));
            let why = match at_end {
                true => format!("particles would become free inside wall '{name}', by up to {deep} m"),
                false => format!("particles would meet wall '{name}' before they have left the shape"),
            };
            let cure = "make the shape smaller, or move it, so that it does not cross the wall";
            return Err(self.check.wrong(key, format!("\"{shape}\""), &why, cure));
        }
        Ok(())
    }

    /// Refuses an insertion whose particles would become free behind a plane at rest.
    fn in_front_of_walls(&self, feed: &Feed, key: &str, shape: &str) -> Result<()> {
        for wall in self.walls.iter().filter(|w| !w.moves()) {
            let WallShape::Plane(plane) = &wall.shape else { continue };
            let lowest = feed.lowest_over(plane);
            if lowest <= 0.0 {
                let (behind, name) = (Shown(-lowest), &wall.name);
                let why =
                    format!("particles would become free {behind} m behind wall '{name}' (plane {plane})");
                let cure = "move the insertion to the side that the plane's normal points to, or turn the normal round";
                return Err(self.check.wrong(key, format!("\"{shape}\""), &why, cure));
            }
        }
        Ok(())
    }
}

impl Insert {
    /// What it says about its grains.
    pub(in crate::plan) fn sized(&self, index: usize) -> EntryGrains<'_> {
        EntryGrains { entry: format!("insert.{index}"), keys: self.grains() }
    }
}

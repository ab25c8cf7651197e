//! Fills that keep clear of walls and of images: placed again where their spheres would lie deep in one.

use crate::error::Result;
use crate::plan::builder::PlanBuilder;
use crate::plan::grains::images::Images;
use crate::plan::grains::obstacles::{Obstacles, Taken, deepest_across};
use geom::Vec3;
use std::sync::Arc;

impl PlanBuilder<'_> {
    /// What a fill finds: all spheres that are placed, and the walls if it is to keep free of them.
    pub(in crate::plan) fn taken(&self) -> Taken {
        Taken { spheres: self.spheres(), walls: self.obstacles.clone() }
    }

    /// What else than each other the spheres of a fill must not touch, for a message.
    pub(in crate::plan) fn in_the_way(&self) -> &'static str {
        if self.obstacles.is_some() { " each other or a wall" } else { "" }
    }

    /// Places all fills again, free of the walls and of all images, if one of their spheres lies so deep in a wall or in the image of another one that the
    /// run would be refused.
    ///
    /// # Errors
    /// As [`PlanBuilder::particles`]: what no longer fits, with its number.
    pub(in crate::plan) fn free_of_walls(&mut self) -> Result<()> {
        let keys = self.keys();
        if keys.fill.is_empty() || (self.walls.is_empty() && keys.domain.periodic.is_empty()) {
            return Ok(());
        }
        let images = Images::new(self.periodic()?);
        let (walls, limit) = (Obstacles::of(&self.walls, images), self.overlap_limit());
        let spheres = self.spheres();
        let in_walls = |(centre, radius): &(Vec3, f64)| walls.deepest(centre, *radius) > limit;
        if !spheres.iter().any(in_walls) && deepest_across(&spheres, &images) <= limit {
            return Ok(());
        }
        let mut again =
            PlanBuilder { hear: self.hear, obstacles: Some(Arc::new(walls)), ..PlanBuilder::new(self.scene) };
        again.clump_shapes()?;
        again.particles()?;
        (self.particles, self.clusters, self.clumps) = (again.particles, again.clusters, again.clumps);
        Ok(())
    }
}

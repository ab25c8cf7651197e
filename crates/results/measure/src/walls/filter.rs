//! Which contacts with walls, and which walls, a measure looks at.

use crate::definition::{AskError, Asked};
use crate::{Contact, Contacts, ForceOnWall, MeasureError, Partner, Run, WallForces};
use geom::{Shape, Vec3};

/// Which contacts are looked at.
#[derive(Debug, Clone)]
pub struct WallContactFilter {
    /// Contact points in this shape; `None`: everywhere.
    pub shape: Option<Shape>,
    /// Only this wall, by name or by index; `None`: all.
    pub wall: Option<String>,
}

impl WallContactFilter {
    /// The rows that are wanted, with those of contacts that have ended.
    ///
    /// # Errors
    /// A wall that the run does not name.
    pub fn of<'c>(
        &'c self,
        run: &'c Run,
        contacts: &'c Contacts,
    ) -> Result<impl Iterator<Item = &'c Contact> + 'c, MeasureError> {
        let wall = self.index(run)?;
        let wanted = move |c: &&Contact| match c.partner {
            Partner::Wall(j) => self.takes(run, wall, j, &c.point),
            Partner::Grain(_) => false,
        };
        Ok(contacts.rows.iter().filter(wanted))
    }

    /// The forces on the walls that are wanted.
    ///
    /// # Errors
    /// A wall that the run does not name.
    pub(crate) fn of_whole<'c>(
        &self,
        forces: &'c WallForces,
    ) -> Result<impl Iterator<Item = &'c ForceOnWall>, MeasureError> {
        let names: Vec<String> = forces.walls.iter().map(|w| w.name.clone()).collect();
        let wall = self.wall.as_ref().map(|name| index(&names, name)).transpose()?;
        let wanted = move |k: usize| wall.is_none_or(|wall| wall == k as u64);
        Ok(forces.walls.iter().enumerate().filter(move |(k, _)| wanted(*k)).map(|(_, w)| w))
    }

    /// The contacts that were asked for: those in a shape, or all, on one wall, or on all.
    pub(crate) fn asked_for(asked: &Asked) -> Result<WallContactFilter, AskError> {
        let given = asked.shape()?;
        let shape = (given.text != "all").then(|| given.shape.clone());
        Ok(WallContactFilter { shape, wall: asked.wall.clone() })
    }

    /// Index of the wall that is wanted; `None`: all.
    ///
    /// # Errors
    /// A wall that the run does not name.
    pub(crate) fn index(&self, run: &Run) -> Result<Option<u64>, MeasureError> {
        self.wall.as_ref().map(|name| index(&run.walls, name)).transpose()
    }

    /// Whether a point of a wall is wanted, where `wanted` is the index of the only one.
    pub(crate) fn takes(&self, run: &Run, wanted: Option<u64>, wall: u64, point: &Vec3) -> bool {
        wanted.is_none_or(|wanted| wanted == wall) && self.holds_point(run, point)
    }

    fn holds_point(&self, run: &Run, point: &Vec3) -> bool {
        self.shape.as_ref().is_none_or(|shape| run.holds(shape, point))
    }
}

fn index(walls: &[String], name: &str) -> Result<u64, MeasureError> {
    let by_name = walls.iter().position(|w| w == name).map(|k| k as u64);
    let by_number = || name.parse().ok().filter(|k: &u64| walls.is_empty() || (*k as usize) < walls.len());
    let missing = || MeasureError::Wall { name: name.to_owned(), has: walls.to_vec() };
    by_name.or_else(by_number).ok_or_else(missing)
}

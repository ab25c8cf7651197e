//! Contact histories of a run and the walls that it had, where another scene starts from its last frame.

use crate::error::{Result, SceneError};
use dem::setup::{KeptContact, WallShape};
use geom::Vec3;
use geom::motion::Pose;
use record::column::{POSITION, RADIUS, WALL};
use record::{Columns, SurfaceShape, WallRecord};
use stream::Table;

/// Contact histories of the last frame of a run.
#[derive(Debug, Clone, Default)]
pub struct RunContacts {
    /// The file.
    pub source: String,
    /// The histories; walls are indices of `walls`.
    pub contacts: Vec<KeptContact>,
    /// The walls of that run.
    pub walls: Vec<RunWall>,
    /// Id, position and radius [m] of its grains in that frame, by id.
    pub grains: Vec<(u32, Vec3, f64)>,
}

/// A wall of a run.
#[derive(Debug, Clone)]
pub struct RunWall {
    /// Its name.
    pub name: String,
    /// Its surface at t = 0.
    pub shape: WallShape,
    /// How far its motion had moved it in the last frame.
    pub pose: Pose,
}

/// The walls of a run in the frame of `end` [ns]; `spheres` is its first message on `/walls`, and when it was written.
///
/// # Errors
/// Columns that are missing or wrong.
pub(super) fn run_walls(
    name: &str,
    records: Vec<WallRecord>,
    spheres: Option<(u64, Table)>,
    end: u64,
) -> Result<Vec<RunWall>> {
    let seconds = |ns: u64| ns as f64 * 1e-9;
    let mut of_wall: Vec<Vec<(Vec3, f64)>> = vec![Vec::new(); records.len()];
    let written = spheres.as_ref().map_or(0.0, |(at, _)| seconds(*at));
    if let Some((_, table)) = &spheres {
        let columns = Columns { name, table };
        let (centres, radii) = (columns.vectors(POSITION)?, columns.numbers(RADIUS)?);
        let walls = columns.needed(WALL, records.len() as f64 - 1.0).map_err(SceneError::from)?;
        for ((centre, radius), wall) in centres.into_iter().zip(radii).zip(walls) {
            of_wall[wall as usize].push((centre, radius));
        }
    }
    let wall = |(record, spheres): (WallRecord, Vec<(Vec3, f64)>)| {
        let first = record.motion.pose(written);
        let home = |(centre, radius): (Vec3, f64)| {
            (if record.motion.moves() { first.home(&centre) } else { centre }, radius)
        };
        let shape = match record.surface {
            Some(SurfaceShape::Plane(plane)) => WallShape::Plane(plane),
            Some(SurfaceShape::Mesh(mesh)) => WallShape::Mesh(mesh),
            None => WallShape::Spheres(spheres.into_iter().map(home).collect()),
        };
        RunWall { name: record.name, shape, pose: record.motion.pose(seconds(end)) }
    };
    Ok(records.into_iter().zip(of_wall).map(wall).collect())
}

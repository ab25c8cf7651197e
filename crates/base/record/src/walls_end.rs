//! How far the walls of a run reach along gravity (metadata `walls_end`).

use crate::Map;
use geom::Vec3;

/// Where the walls of a run end: what is farther along gravity has fallen past all of them, and falls on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WallsEnd {
    /// Direction of gravity [–].
    pub down: Vec3,
    /// How far along it any wall reaches [m].
    pub depth: f64,
}

impl WallsEnd {
    /// Reads a record; `None` where a number is missing or malformed.
    pub fn read(map: &Map) -> Option<WallsEnd> {
        let numbers: Vec<f64> = map.get("down")?.split(',').map(str::parse).collect::<Result<_, _>>().ok()?;
        let &[x, y, z] = numbers.as_slice() else { return None };
        Some(WallsEnd { down: Vec3::new(x, y, z), depth: map.get("depth")?.parse().ok()? })
    }

    /// Whether a sphere [m] has fallen past all walls.
    pub fn is_past(&self, centre: &Vec3, radius: f64) -> bool {
        centre.dot(&self.down) - radius > self.depth
    }
}

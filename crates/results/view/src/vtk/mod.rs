//! Files for ParaView and whatever else reads VTK: points with all fields, walls, meshes.
//!
//! | `role` | is |
//! |---|---|
//! | 0 | grains |
//! | 1 | points of a cloud |
//! | 2 | wall spheres |
//! | 3 | corners of planes and meshes |
//! | 4 | middles of bonds |
//! | 5 | starts of arrows |

mod collection;
mod fields;
mod ply;
mod polydata;
mod series;

pub use collection::{Entry, write as write_collection};
pub use polydata::{Field, PolyData};
pub use series::SeriesFolder;

use crate::appearance::scale::Range;
use crate::things::{outline::Outline, sheet, sheet::box_of, spheres::Spheres};
use crate::{DrawnTable, Role, ViewError, WallSurface};
use stream::{Table, Values};

/// What stands in the field `role` for planes and meshes.
const SURFACE: u8 = 3;

/// How far things reach: a plane, which goes on for ever, is written as far as that.
#[derive(Clone, Default)]
pub struct Reach(Outline);

impl Reach {
    /// Takes in a table of spheres or points; `name` is for messages.
    ///
    /// # Errors
    /// A position or radius is missing or not finite.
    pub fn add(&mut self, role: Role, table: &Table, name: &str) -> Result<(), ViewError> {
        self.0.add_spheres(&Spheres::of(table, name)?, &[], role != Role::Walls, None);
        Ok(())
    }

    fn extent(&self) -> [Range; 3] {
        box_of(&self.0.points())
    }
}

/// Everything at one moment, in one set; the field `role` tells things apart, and a field that one of them lacks is
/// NaN there, or 0 if it counts.
///
/// # Errors
/// Nothing at all; a position or radius that is missing or not finite.
pub fn moment(
    parts: &[DrawnTable],
    surfaces: &[WallSurface],
    time: Option<f64>,
) -> Result<PolyData, ViewError> {
    let mut reach = Reach::default();
    let mut whole = PolyData::default();
    for part in parts {
        reach.add(part.role, part.table, &part.name)?;
        join(&mut whole, points(part.role, part.table));
    }
    join(&mut whole, walls(surfaces, &reach, time.unwrap_or(0.0)));
    if whole.is_empty() {
        return Err(ViewError::Empty);
    }
    Ok(PolyData { time, ..whole })
}

/// A table of spheres or points with all its fields; x, y and z must be there.
pub fn points(role: Role, table: &Table) -> PolyData {
    let axes = ["x", "y", "z"].map(|axis| table.get(axis));
    let single = axes.iter().all(|axis| matches!(axis, Some(Values::F32(_))));
    let axes = axes.map(|axis| axis.map(Values::to_f64).unwrap_or_default());
    let rows = axes.iter().map(Vec::len).min().unwrap_or(0);
    let points = (0..rows).flat_map(|i| [axes[0][i], axes[1][i], axes[2][i]]).collect();
    let mut fields = fields::of(table);
    fields.retain(|field| field.name != "role");
    fields.push(roles(role.number(), rows));
    PolyData { time: None, points, single, fields, alone: rows, faces: Vec::new() }
}

/// Planes, as far as `reach`, and meshes, where they are at `time` [s]; the field `surface` counts them.
pub fn walls(surfaces: &[WallSurface], reach: &Reach, time: f64) -> PolyData {
    let mut all = PolyData::default();
    for (number, sheet) in sheet::sheets(surfaces, reach.extent()).into_iter().enumerate() {
        let pose = sheet.surface.motion.pose(time);
        let points: Vec<f64> =
            sheet.vertices.iter().flat_map(|v| <[f64; 3]>::from(pose.position(v))).collect();
        let rows = sheet.vertices.len();
        let number = Values::U16(vec![number.min(usize::from(u16::MAX)) as u16; rows]);
        let fields =
            vec![Field { name: "surface".into(), components: 1, values: number }, roles(SURFACE, rows)];
        join(&mut all, PolyData { points, fields, faces: sheet.faces, ..PolyData::default() });
    }
    all
}

fn roles(role: u8, rows: usize) -> Field {
    Field { name: "role".into(), components: 1, values: Values::U8(vec![role; rows]) }
}

/// Appends a set; sets of points come before those with faces.
fn join(whole: &mut PolyData, more: PolyData) {
    if whole.is_empty() {
        *whole = more;
        return;
    }
    let (rows, count) = (whole.len(), more.len());
    fields::append(&mut whole.fields, rows, more.fields, count);
    whole.points.extend(more.points);
    whole.single &= more.single || count == 0;
    whole.alone += more.alone;
    whole.faces.extend(more.faces.iter().map(|face| face.map(|corner| corner + rows as u32)));
}

//! What is drawn: every sphere of every part, with its colour, and thin walls.

use super::{
    PictureOptions,
    key::{Key, plain},
    survey::Survey,
};
use crate::{Role, SurfaceShape, ViewError, WallSurface, scale::Range, sheet, spheres::Spheres};
use geom::Vec3;
use stream::Table;

/// One table to draw.
#[derive(Debug, Clone)]
pub struct DrawnTable<'a> {
    /// How it is drawn.
    pub role: Role,
    /// For messages.
    pub name: String,
    /// x, y, z, radius, fields.
    pub table: &'a Table,
    /// Names of the kinds that the field `material` counts.
    pub kinds: Vec<String>,
}

/// One kind of thing, ready to draw.
pub(crate) struct PaintedLayer {
    pub role: Role,
    pub spheres: Spheres,
    /// A colour for each sphere, parts 0 to 1.
    pub colour: Vec<[f32; 3]>,
}

/// A plane or mesh where it is at the moment.
pub(crate) struct Pane {
    /// Corners of its faces [m].
    pub faces: Vec<[Vec3; 3]>,
    /// Ends of its lines [m].
    pub lines: Vec<[Vec3; 2]>,
    /// How much a line hides [–].
    pub ink: f32,
    /// Whether it hides all that is behind it.
    pub opaque: bool,
    /// A point and the normal [m] of a plane, which points to the grains.
    pub side: Option<[Vec3; 2]>,
}

/// Everything in the picture.
pub(crate) struct Painted {
    pub layers: Vec<PaintedLayer>,
    pub panes: Vec<Pane>,
    /// Places that the camera must see [m].
    pub outline: Vec<Vec3>,
    pub key: Key,
    /// Box that the view is fitted to [m].
    pub extent: [Range; 3],
}

impl Painted {
    /// What is there at a moment that `survey` knows.
    pub fn new(
        parts: &[DrawnTable],
        surfaces: &[WallSurface],
        survey: &Survey,
        options: &PictureOptions,
    ) -> Result<Painted, ViewError> {
        if survey.role().is_none() && surfaces.is_empty() {
            return Err(ViewError::Empty);
        }
        let key = survey.key(options);
        let mut layers = Vec::new();
        for part in parts.iter().filter(|p| p.table.rows() > 0) {
            let spheres = Spheres::of(part.table, &part.name)?;
            let shown = survey.role() == Some(part.role);
            let colour = if shown { key.colours(part.table) } else { plain(spheres.len()) };
            layers.push(PaintedLayer { role: part.role, spheres, colour });
        }
        let mut painted =
            Painted { layers, panes: Vec::new(), outline: Vec::new(), key, extent: survey.extent() };
        painted.place(surfaces, survey, options.time.unwrap_or(0.0));
        Ok(painted)
    }

    /// Places the surfaces; a plane is looked at where there is nothing else.
    fn place(&mut self, surfaces: &[WallSurface], survey: &Survey, time: f64) {
        let mut outline = survey.outline.clone();
        self.outline = outline.points();
        for sheet in sheet::sheets(surfaces, self.extent) {
            let pose = sheet.surface.motion.pose(time);
            let vertices: Vec<Vec3> = sheet.vertices.iter().map(|v| pose.position(v)).collect();
            let faces = sheet.faces.iter().map(|f| f.map(|v| vertices[v as usize])).collect();
            let lines = sheet.lines.iter().map(|l| l.map(|v| pose.position(&v))).collect();
            let side = match &sheet.surface.shape {
                SurfaceShape::Plane(p) => Some([
                    pose.position(&p.point),
                    pose.position(&(p.point + p.normal)) - pose.position(&p.point),
                ]),
                SurfaceShape::Mesh(_) => None,
            };
            if sheet.whole && side.is_some() && self.outline.is_empty() {
                outline.add(&vertices);
            }
            let opaque = sheet.closed && self.layers.is_empty();
            self.panes.push(Pane { faces, lines, ink: sheet.ink, opaque, side });
        }
        self.outline = outline.points();
        self.extent = sheet::box_of(&self.outline);
    }

    /// Middle of what is looked at [m].
    pub fn middle(&self) -> Vec3 {
        Vec3::from_fn(|k, _| 0.5 * (self.extent[k].lo + self.extent[k].hi))
    }

    /// A ball around what is looked at: middle and radius [m].
    pub fn ball(&self) -> (Vec3, f64) {
        let side = Vec3::from_fn(|k, _| (self.extent[k].hi - self.extent[k].lo).max(0.0));
        (self.middle(), 0.5 * side.norm())
    }
}

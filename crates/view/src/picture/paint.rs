//! What is drawn: every sphere of every part, with its colour, and thin walls.

use super::PictureOptions;
use crate::{
    Role, Surface, SurfaceShape, ViewError, colour, field, outline::Outline, scale::Range, sheet,
    spheres::Spheres,
};
use geom::Vec3;
use stream::Table;

/// One table to draw.
#[derive(Debug, Clone)]
pub struct Part<'a> {
    /// How it is drawn.
    pub role: Role,
    /// For messages.
    pub name: String,
    /// x, y, z, radius, fields.
    pub table: &'a Table,
    /// Names of the kinds that the field `material` counts.
    pub kinds: Vec<String>,
}

/// What the colours mean.
pub(crate) enum Key {
    /// A range of a field.
    Bar { field: String, unit: &'static str, range: Range, beyond: [bool; 2] },
    /// Kinds by number, with their names.
    Kinds { field: String, names: Vec<String> },
    /// The colours of the scan itself.
    None,
}

/// One kind of thing, ready to draw.
pub(crate) struct Layer {
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
    /// A point and the normal [m] of a plane, which points to the grains.
    pub side: Option<[Vec3; 2]>,
}

/// Everything in the picture.
pub(crate) struct Painted {
    pub layers: Vec<Layer>,
    pub panes: Vec<Pane>,
    /// Places that the camera must see [m].
    pub outline: Vec<Vec3>,
    pub key: Key,
    /// Box that the view is fitted to [m].
    pub extent: [Range; 3],
}

impl Painted {
    pub fn new(parts: &[Part], surfaces: &[Surface], options: &PictureOptions) -> Result<Painted, ViewError> {
        let parts: Vec<&Part> = parts.iter().filter(|p| p.table.rows() > 0).collect();
        if parts.is_empty() && surfaces.is_empty() {
            return Err(ViewError::Empty);
        }
        let mut painted = Painted::bare();
        if let Some(main) = parts.iter().map(|p| p.role).min() {
            let (key, colour_of) = key(&parts, main, options)?;
            painted.key = key;
            for part in &parts {
                let spheres = Spheres::of(part.table, &part.name)?;
                let plain = || vec![colour::fraction(colour::WALL); spheres.len()];
                let colour = if part.role == main { colour_of(part.table) } else { plain() };
                painted.layers.push(Layer { role: part.role, spheres, colour });
            }
        }
        painted.frame(surfaces, options.time.unwrap_or(0.0));
        Ok(painted)
    }

    fn bare() -> Painted {
        let (layers, panes, outline) = (Vec::new(), Vec::new(), Vec::new());
        Painted { layers, panes, outline, key: Key::None, extent: [Range::EMPTY; 3] }
    }

    /// Places the surfaces, and finds what the camera must see: all but strays among the grains.
    fn frame(&mut self, surfaces: &[Surface], time: f64) {
        let mut outline = Outline::default();
        for layer in &self.layers {
            outline.add_spheres(&layer.spheres, layer.role != Role::Walls);
        }
        let around = sheet::box_of(&outline.places());
        for sheet in sheet::sheets(surfaces, around) {
            let place = sheet.surface.motion.to(time);
            let vertices: Vec<Vec3> = sheet.vertices.iter().map(|v| place(*v)).collect();
            if sheet.whole {
                outline.add(&vertices);
            }
            let faces = sheet.faces.iter().map(|f| f.map(|v| vertices[v as usize])).collect();
            let lines = sheet.lines.iter().map(|l| l.map(&place)).collect();
            let side = match &sheet.surface.shape {
                SurfaceShape::Plane(p) => Some([place(p.point), place(p.point + p.normal) - place(p.point)]),
                SurfaceShape::Mesh(_) => None,
            };
            self.panes.push(Pane { faces, lines, ink: sheet.ink, side });
        }
        self.outline = outline.places();
        self.extent = sheet::box_of(&self.outline);
    }

    /// Middle of what is looked at [m].
    pub fn middle(&self) -> Vec3 {
        Vec3::from_fn(|k, _| 0.5 * (self.extent[k].lo + self.extent[k].hi))
    }
}

type ColourOf<'a> = Box<dyn Fn(&Table) -> Vec<[f32; 3]> + 'a>;

/// The meaning of the colours, and the colours of a table by it.
fn key<'a>(
    parts: &[&Part],
    main: Role,
    options: &'a PictureOptions,
) -> Result<(Key, ColourOf<'a>), ViewError> {
    let tables = || parts.iter().filter(|p| p.role == main).map(|p| p.table);
    let first = tables().next().ok_or(ViewError::Empty)?;
    let asked = options.colour.as_deref().map(field::canonical);
    if asked.is_none_or(|f| f == "rgb") && scan_colours(first).is_some() {
        return Ok((Key::None, Box::new(|t| scan_colours(t).unwrap_or_else(|| plain(t)))));
    }
    let name = asked.map_or_else(|| field::default_of(first), str::to_owned);
    let values: Vec<f64> = tables().filter_map(|t| field::values(t, &name)).flatten().collect();
    if values.is_empty() {
        let known = field::names(first, true).into_iter().chain(["x", "y", "z"].map(str::to_owned));
        return Err(ViewError::NoField { name, known: known.collect() });
    }
    let all = Range::of(&values);
    if field::is_whole(first, &name) && all.lo >= 0.0 && all.hi < colour::KIND_COUNT as f64 {
        let given = parts.iter().find(|p| p.role == main).map(|p| p.kinds.clone()).unwrap_or_default();
        let names = (0..=all.hi as usize).map(|k| given.get(k).cloned().unwrap_or_else(|| k.to_string()));
        let key = Key::Kinds { field: name.clone(), names: names.collect() };
        return Ok((key, Box::new(move |t| by_kind(t, &name))));
    }
    let range = match options.range {
        Some([lo, hi]) => Range { lo, hi },
        None => Range::of_most(&values).opened(),
    };
    let slack = 1e-9 * (range.hi - range.lo);
    let beyond = [all.lo < range.lo - slack, all.hi > range.hi + slack];
    let key = Key::Bar { unit: field::unit(&name), field: name.clone(), range, beyond };
    Ok((key, Box::new(move |t| by_value(t, &name, range, options.map))))
}

fn by_value(table: &Table, name: &str, range: Range, map: crate::Map) -> Vec<[f32; 3]> {
    let steps: Vec<[f32; 3]> = (0..=1023).map(|i| map.at(f64::from(i) / 1023.0)).collect();
    let one = |v: f64| steps[(1023.0 * range.share(v)) as usize];
    field::values(table, name).map_or_else(|| plain(table), |values| values.into_iter().map(one).collect())
}

fn by_kind(table: &Table, name: &str) -> Vec<[f32; 3]> {
    let one = |v: f64| colour::fraction(colour::kind(v as usize));
    field::values(table, name).map_or_else(|| plain(table), |values| values.into_iter().map(one).collect())
}

fn plain(table: &Table) -> Vec<[f32; 3]> {
    vec![colour::fraction(colour::WALL); table.rows()]
}

/// The scan's own colours, when it has them as bytes.
fn scan_colours(table: &Table) -> Option<Vec<[f32; 3]>> {
    let byte = |name| match table.get(name) {
        Some(stream::Values::U8(v)) => Some(v),
        _ => None,
    };
    let (r, g, b) = (byte("red")?, byte("green")?, byte("blue")?);
    Some((0..table.rows()).map(|i| colour::fraction([r[i], g[i], b[i]])).collect())
}

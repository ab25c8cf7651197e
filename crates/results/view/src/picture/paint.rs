//! What is drawn: every sphere of every part, with its colour, and thin walls.

use super::{
    chains::{ChainCount, ChainKey},
    counts::Counts,
    drawn_table::DrawnTable,
    key::{Key, plain},
    options::PictureOptions,
    rod::Rod,
    shapes::{self, ArrowKey},
    solid::rods,
    survey::Survey,
    theme::Theme,
    walls::WallKey,
};
use crate::appearance::scale::Range;
use crate::things::{extras::GRAINS, sheet, solid::Solid, spheres::Spheres};
use crate::{OutlineKind, Role, SurfaceShape, ViewError, WallSurface};
use geom::Vec3;

/// Edges and faces of the clumps that are polyhedra, with the place of each in `bodies`.
fn solids(
    part: &DrawnTable,
    spheres: &Spheres,
    bodies: &[Vec<u32>],
    colour: &[[f32; 3]],
) -> Vec<(usize, Vec<Rod>)> {
    let known: Vec<Solid> = part.clumps.iter().filter_map(Solid::of).collect();
    let solid = |(n, rows): (usize, &Vec<u32>)| {
        let solid = known.iter().find(|solid| solid.fits(spheres, rows))?;
        Some((n, rods(solid, spheres, rows, colour[rows[0] as usize])))
    };
    bodies.iter().enumerate().filter_map(solid).collect()
}

/// One kind of thing, ready to draw.
pub(crate) struct PaintedLayer<'a> {
    pub role: Role,
    pub spheres: Spheres<'a>,
    /// A colour for each sphere, parts 0 to 1.
    pub colour: Vec<[f32; 3]>,
    /// Whether they are wall spheres that are coloured by what was done to them.
    pub worn: bool,
    /// The spheres of each clump.
    pub bodies: Vec<Vec<u32>>,
    /// Edges and faces of those that are polyhedra, with the place in `bodies`.
    pub solids: Vec<(usize, Vec<Rod>)>,
}

/// A plane or mesh where it is at the moment.
pub(crate) struct Pane {
    /// Corners of its faces [m].
    pub faces: Vec<[Vec3; 3]>,
    /// A colour for each face, parts 0 to 1; none: that of walls.
    pub colour: Option<Vec<[f32; 3]>>,
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
pub(crate) struct Painted<'a> {
    pub layers: Vec<PaintedLayer<'a>>,
    /// Bonds, cracks, contacts and arrows.
    pub rods: Vec<Rod>,
    /// Lines of outlines.
    pub lines: Vec<Rod>,
    /// Whole and broken bonds; none where they are not shown.
    pub bonds: Option<[usize; 2]>,
    /// Size of the grains as drawn [–].
    pub shrunk: f64,
    pub arrows: Option<ArrowKey>,
    /// What force chains mean, and how many are drawn; grains are faint then.
    pub chains: Option<(ChainKey, ChainCount)>,
    /// Kinds and names of outlines.
    pub outlines: Vec<(OutlineKind, String)>,
    /// Most grains, wall spheres and points of all moments.
    pub counts: Counts,
    pub panes: Vec<Pane>,
    /// Places that the camera must see [m].
    pub outline: Vec<Vec3>,
    pub key: Key,
    /// What the colours of walls mean, where they are coloured.
    pub wall_key: Option<WallKey>,
    /// Box that the view is fitted to [m].
    pub extent: [Range; 3],
}

impl Painted<'_> {
    /// What is there at a moment that `survey` knows.
    pub fn new<'a>(
        parts: &[DrawnTable<'a>],
        surfaces: &[WallSurface],
        survey: &Survey,
        options: &PictureOptions,
    ) -> Result<Painted<'a>, ViewError> {
        if survey.is_empty() && surfaces.iter().all(|surface| options.hidden.hides_surface(&surface.name)) {
            return Err(ViewError::Empty);
        }
        let (key, wall_key) = (survey.key(options), survey.wall_key(options));
        let mut layers = Vec::new();
        let shrunk = if parts.iter().any(|p| p.role.lies_in_grains()) { GRAINS } else { 1.0 };
        let shown = |p: &&DrawnTable| !options.hidden.hides_layer(p.role, &p.name);
        for part in parts.iter().filter(shown).filter(|p| p.table.rows() > 0 && !p.role.is_rods()) {
            let mut spheres = Spheres::of(part.table, &part.name)?;
            if part.role == Role::Grains {
                spheres.shrunk = shrunk;
            }
            let shown = survey.role() == Some(part.role);
            let bodies = part.bodies();
            let worn = wall_key.as_ref().filter(|_| part.role == Role::Walls);
            let worn = worn.and_then(|key| key.of_spheres(part.table));
            let is_worn = worn.is_some();
            let colour = match worn {
                Some(worn) => worn,
                None if shown => key.colours(part.table, &bodies),
                None => plain(spheres.len()),
            };
            let solids = if shrunk == 1.0 { solids(part, &spheres, &bodies, &colour) } else { Vec::new() };
            layers.push(PaintedLayer { role: part.role, spheres, colour, worn: is_worn, bodies, solids });
        }
        let mut painted = Painted {
            layers,
            rods: Vec::new(),
            lines: Vec::new(),
            bonds: None,
            shrunk,
            arrows: survey.arrows(),
            chains: survey.chains(options).map(|key| (key, ChainCount::default())),
            outlines: Vec::new(),
            counts: survey.counts(),
            panes: Vec::new(),
            outline: Vec::new(),
            key,
            wall_key,
            extent: survey.extent(),
        };
        parts.iter().filter(shown).for_each(|part| painted.add_rods(part, options));
        painted.place(surfaces, survey, options);
        Ok(painted)
    }

    fn add_rods(&mut self, part: &DrawnTable, options: &PictureOptions) {
        match (part.role, &self.arrows) {
            (Role::ForceChains, _) => {
                let Some((key, count)) = &mut self.chains else { return };
                let (rods, own) = key.rods(part.table);
                *count = count.plus(own);
                self.rods.extend(rods);
            }
            (Role::Outline(kind), _) => {
                self.lines.extend(shapes::outlines(part.table, kind.colour()));
                self.outlines.push((kind, part.name.clone()));
            }
            (Role::Bonds, _) => {
                let (rods, [whole, broken]) = shapes::bonds(part.table);
                let before = self.bonds.unwrap_or_default();
                self.bonds = Some([before[0] + whole, before[1] + broken]);
                self.rods.extend(rods);
            }
            (Role::Arrows(_), Some(key)) => {
                self.rods.extend(shapes::arrows(part.table, key, Theme::of(options.dark).arrow));
            }
            _ => {}
        }
    }

    /// Places the surfaces; a plane is looked at where there is nothing else.
    fn place(&mut self, surfaces: &[WallSurface], survey: &Survey, options: &PictureOptions) {
        let time = options.time.unwrap_or(0.0);
        let mut outline = survey.outline.clone();
        self.outline = outline.points();
        for (number, sheet) in sheet::sheets(surfaces, self.extent).into_iter().enumerate() {
            if options.hidden.hides_surface(&sheet.surface.name) {
                continue;
            }
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
            let opaque =
                sheet.closed && self.layers.is_empty() && self.rods.is_empty() && self.lines.is_empty();
            let values = options.surface_values.get(number).and_then(Option::as_ref);
            let colour = self.wall_key.as_ref().zip(values).map(|(key, values)| {
                let value = |part: &u32| f64::from(values.get(*part as usize).copied().unwrap_or(0.0));
                key.colours(sheet.parts.iter().map(value))
            });
            self.panes.push(Pane { faces, colour, lines, ink: sheet.ink, opaque, side });
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

//! One self-contained HTML page that shows a run, its walls, and clouds; it asks for nothing over a network.
//!
//! Frames are packed as they come (positions as 16-bit numbers in a box of their own), so a run that does not fit
//! in memory can be shown; when the page grows beyond its limit, first the components of vectors are left out, of
//! which the lengths stay, then every second frame, again and again; what is then still too big is refused.

mod blobs;
mod exact;
mod fit;
mod pack;
mod page_field;
mod page_rods;
mod panes;
mod solids;
mod timeline;
mod worn;
mod write;

use crate::appearance::{classes::Sizes, field, scale::Range, wall_scale::WallSurvey};
use crate::things::{
    bodies::{bodies, even_out},
    extras,
    outline::Outline,
    spheres::Spheres,
};
use crate::{
    Camera, Diagram, GrainCount, Hidden, Map, Motion, Role, ViewError, WallScale, WallSurface,
    picture::{self, ArrowKey},
};
use exact::Exact;
use pack::Packed;
use page_field::{Field, new_fields};
use record::{ClumpRecord, WallsEnd, column::RADIUS};
use solids::PageSolids;
use std::collections::BTreeMap;
use stream::{Table, Values};
use timeline::Timeline;
use worn::WearTrack;

/// A page's settings.
#[derive(Debug, Clone)]
pub struct PageOptions {
    /// Shown as the page's title.
    pub title: String,
    /// Field to colour by first; none: speed, else height.
    pub colour: Option<String>,
    /// Colour map shown first.
    pub map: Map,
    /// Ends of the colour scale in the field's unit; none: what 98 % of the values lie in.
    pub range: Option<[f64; 2]>,
    /// Where to look from first.
    pub camera: Camera,
    /// Time to show first [s]; with none, the run plays.
    pub time: Option<f64>,
    /// Size the page should stay below [byte].
    pub most_bytes: usize,
    /// Whether components of vectors stay, and frames are left out instead.
    pub components: bool,
    /// Whether regions can be drawn on it: the file that `cloud-crop` is to be given.
    pub pick: Option<String>,
    /// Dark colours first; else those of the system.
    pub dark: bool,
    /// What is not shown at first.
    pub hidden: Hidden,
    /// What walls are coloured by; none: they are grey.
    pub walls: Option<WallScale>,
}

impl Default for PageOptions {
    fn default() -> Self {
        PageOptions {
            title: "Grainpipe".to_owned(),
            colour: None,
            map: Map::default(),
            range: None,
            camera: Camera::default(),
            time: None,
            most_bytes: 60_000_000,
            components: false,
            pick: None,
            dark: false,
            hidden: Hidden::default(),
            walls: None,
        }
    }
}

/// What the page holds, and what was left out.
#[derive(Debug, Clone, PartialEq)]
pub struct PageContent {
    /// Frames given.
    pub given: usize,
    /// Frames in the page.
    pub kept: usize,
    /// One frame of so many is in the page, and the last.
    pub stride: usize,
    /// Bound on the error of a position by packing [m].
    pub position_error: f64,
    /// Bound on the error of a radius by packing [m].
    pub radius_error: f64,
    /// Bound on the error of each field by packing, in its unit.
    pub field_errors: Vec<(String, f64)>,
    /// Whether components of vectors were left out.
    pub lengths_only: bool,
    /// One point of so many is on the page, where regions are drawn.
    pub one_point_of: usize,
}

/// One thing shown: a file's grains, walls or cloud.
pub(crate) struct PageLayer {
    pub name: String,
    pub role: Role,
    /// Names of the kinds that the field `material` counts.
    pub kinds: Vec<String>,
    pub fields: Vec<Field>,
    pub frames: Timeline,
    /// Radius of points without their own [m]; zero when spheres have theirs.
    pub point_radius: f64,
    /// Places that stand out, as pushed [m].
    pub outline: Outline,
    /// The same of grains that are far from all others; none where there is none.
    pub strays: Outline,
    /// Clumps that are polyhedra.
    pub solids: PageSolids,
    /// How it moves besides.
    pub motion: Motion,
    /// The positions to the last bit, where regions are drawn.
    pub exact: Option<Exact>,
    /// Of arrows: largest length that is not rare, in the unit of their vectors, and mean radius of the grains [m].
    pub reach: [f64; 2],
    /// Of wall spheres: what grains did to them.
    pub wear: WearTrack,
}

/// A page in the making.
pub struct Page {
    options: PageOptions,
    layers: Vec<PageLayer>,
    surfaces: Vec<WallSurface>,
    /// What grains did to the triangles of surfaces, by their numbers.
    worn: BTreeMap<usize, WearTrack>,
    wall_survey: WallSurvey,
    walls_end: Option<WallsEnd>,
    given: usize,
    stride: usize,
    lengths_only: bool,
    one_point_of: usize,
    sizes: Sizes,
    diagrams: Vec<Diagram>,
    notes: Vec<String>,
}

impl Page {
    /// A page without anything in it.
    pub fn new(options: PageOptions) -> Page {
        let (layers, surfaces) = (Vec::new(), Vec::new());
        Page {
            options,
            layers,
            surfaces,
            worn: BTreeMap::new(),
            wall_survey: WallSurvey::default(),
            walls_end: None,
            given: 0,
            stride: 1,
            lengths_only: false,
            one_point_of: 1,
            sizes: Sizes::default(),
            diagrams: Vec::new(),
            notes: Vec::new(),
        }
    }

    /// Adds a sentence below the title that the reader must not miss, such as what stopped the run.
    pub fn note(&mut self, text: String) {
        self.notes.push(text);
    }

    /// Adds a layer; its number is for [`Page::push`].
    pub fn layer(&mut self, role: Role, name: &str) -> usize {
        self.layers.push(PageLayer {
            name: name.to_owned(),
            role,
            kinds: Vec::new(),
            fields: Vec::new(),
            frames: Timeline::default(),
            point_radius: 0.0,
            outline: Outline::default(),
            strays: Outline::default(),
            solids: PageSolids::default(),
            motion: Motion::default(),
            exact: None,
            reach: [0.0; 2],
            wear: WearTrack::default(),
        });
        self.layers.len() - 1
    }

    /// Names the kinds that the field `material` of a layer counts.
    pub fn kinds(&mut self, layer: usize, kinds: Vec<String>) {
        self.layers[layer].kinds = kinds;
    }

    /// Shapes of the clumps of a layer.
    pub fn clumps(&mut self, layer: usize, clumps: &[ClumpRecord]) {
        self.layers[layer].solids = PageSolids::of(clumps);
    }

    /// Lets a layer move as one body; what is pushed is where its spheres are at t = 0.
    pub fn moves(&mut self, layer: usize, motion: Motion) {
        self.layers[layer].motion = motion;
    }

    /// Adds diagrams beside the picture.
    pub fn diagrams(&mut self, diagrams: Vec<Diagram>) {
        self.diagrams.extend(diagrams);
    }

    /// Adds a wall that is a plane or a mesh; its number is for [`Page::wear`].
    pub fn surface(&mut self, surface: WallSurface) -> usize {
        self.surfaces.push(surface);
        self.surfaces.len() - 1
    }

    /// Adds what a layer looks like at `time` [s] and after; times of a layer must not fall.
    ///
    /// # Errors
    /// A table without positions, or with a position that is not finite; a page beyond its limit.
    pub fn push(&mut self, layer: usize, time: f64, table: &Table) -> Result<(), ViewError> {
        let chosen = self.every_so_many(table).or_else(|| by_id(table));
        let table = chosen.as_ref().unwrap_or(table);
        let all_fields = self.options.components || !self.lengths_only;
        let layer = &mut self.layers[layer];
        let spheres = Spheres::of(table, &layer.name)?;
        let moving = layer.role == Role::Grains;
        if layer.frames.is_empty() {
            let sized = spheres.sized() && !layer.role.is_rods();
            layer.fields = new_fields(table, all_fields, sized, self.options.colour.as_deref());
            let points = !spheres.sized() && spheres.len() > 0;
            layer.point_radius = if points { spheres.radius(0) } else { 0.0 };
            layer.exact = self.options.pick.as_ref().map(|_| Exact::of(&spheres.centre, table));
        }
        if moving && spheres.sized() {
            self.sizes.add(spheres.radii().map(|r| 2.0 * r));
        }
        let bodies = if moving { bodies(table) } else { Vec::new() };
        if layer.role.is_rods() {
            layer.add_reach(table, &spheres);
        } else {
            let end = self.walls_end.filter(|_| moving);
            layer.outline.add_spheres(&spheres, &bodies, layer.role != Role::Walls, end);
            if layer.outline.leaves_out(&spheres) {
                layer.strays.add_spheres(&spheres, &[], false, None);
            }
        }
        let last = layer.frames.last();
        let mut packed = Packed::new(time, &spheres, last);
        packed.grains = GrainCount::with(spheres.len(), &bodies);
        packed.solids = layer.solids.find(&spheres, &bodies, last);
        for field in &mut layer.fields {
            let mut values = field::values(table, &field.name).unwrap_or_else(|| vec![0.0; table.rows()]);
            if !field.whole && field.name != RADIUS {
                even_out(&mut values, &bodies);
            }
            field.all = field.all.with(Range::of(&values));
            field.most = field.most.with(Range::of_most(&values));
            packed.add(field, &values, last);
        }
        layer.frames.push(packed, self.stride);
        self.given += usize::from(moving);
        self.fit()
    }

    /// The grains of the last frame.
    pub fn grains(&self) -> GrainCount {
        let layers = self.layers.iter().filter(|l| l.role == Role::Grains);
        let last = layers.filter_map(|l| l.frames.last()).map(|frame| frame.grains);
        last.fold(GrainCount::default(), GrainCount::plus)
    }

    /// What became of the frames so far.
    pub fn kept(&self) -> PageContent {
        let grains = self.layers.iter().filter(|l| l.role == Role::Grains);
        let error = |of: fn(&Packed) -> f64| {
            self.layers.iter().flat_map(|l| l.frames.iter()).map(of).fold(0.0, f64::max)
        };
        let mut field_errors: Vec<(String, f64)> = Vec::new();
        for (name, error) in self.layers.iter().flat_map(PageLayer::field_errors) {
            match field_errors.iter_mut().find(|(known, _)| *known == name) {
                Some((_, most)) => *most = most.max(error),
                None => field_errors.push((name, error)),
            }
        }
        PageContent {
            given: self.given,
            kept: grains.map(|l| l.frames.len()).sum(),
            stride: self.stride,
            position_error: error(Packed::position_error),
            radius_error: error(|p| p.radius.error()),
            field_errors,
            lengths_only: self.lengths_only,
            one_point_of: self.one_point_of,
        }
    }
}

impl PageLayer {
    /// Takes in the lengths of arrows.
    fn add_reach(&mut self, table: &Table, spheres: &Spheres) {
        let [x, y, z] = extras::ALONG.map(|c| table.get(c).map(Values::to_f64).unwrap_or_default());
        let length = |k: usize| (x[k] * x[k] + y[k] * y[k] + z[k] * z[k]).sqrt();
        let most = Range::of_most((0..x.len()).map(length)).hi;
        let usual = spheres.radii().sum::<f64>() / spheres.len().max(1) as f64;
        self.reach = [self.reach[0].max(most), self.reach[1].max(usual)];
    }

    /// What the lengths of arrows mean.
    fn arrow_key(&self) -> Option<ArrowKey> {
        match self.role {
            Role::Arrows(of) => Some(picture::arrow_key(of, self.reach[0], self.reach[1])),
            _ => None,
        }
    }

    /// Name and bound on the error by packing of each field.
    fn field_errors(&self) -> impl Iterator<Item = (String, f64)> {
        self.fields.iter().enumerate().map(|(n, field)| {
            let of = self.frames.iter().filter_map(|f| f.fields.get(n));
            (field.name.clone(), of.map(pack::Column::error).fold(0.0, f64::max))
        })
    }
}

/// The rows in the order of their id, so that what stays the same between frames is the same column of bytes.
fn by_id(table: &Table) -> Option<Table> {
    let id = table.get("id")?.to_f64();
    if id.is_sorted() {
        return None;
    }
    let mut order: Vec<u32> = (0..table.rows() as u32).collect();
    order.sort_by(|&a, &b| id[a as usize].total_cmp(&id[b as usize]));
    Some(table.select(&order))
}

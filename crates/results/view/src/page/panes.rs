//! Thin walls in a page, packed once: where they are at t = 0, and how they move.

use super::{Page, PageLayer};
use crate::appearance::scale::Range;
use crate::things::{outline::Outline, sheet};
use crate::{Motion, Role, SurfaceShape, WallSurface};
use geom::Vec3;
use serde_json::Value;
use std::sync::Arc;

/// Moments at which moving walls are looked at for the camera, at most.
const MOMENTS: usize = 32;

/// A plane or mesh, packed.
pub(super) struct Pane {
    pub name: String,
    pub motion: Motion,
    /// What the places are relative to [m].
    pub origin: Vec3,
    /// x, y, z of each corner, as 4-byte numbers [m].
    pub vertices: Arc<Vec<u8>>,
    /// Three corners of each face, as 4-byte numbers.
    pub faces: Arc<Vec<u8>>,
    /// Numbers of the faces in the run, as 4-byte numbers; none where each has its own place.
    pub parts: Option<Arc<Vec<u8>>>,
    /// x, y, z of both ends of each line, as 4-byte numbers [m].
    pub lines: Arc<Vec<u8>>,
    /// How much a line hides [–].
    pub ink: f32,
    /// Normal of a plane, which points to the grains.
    pub normal: Option<Vec3>,
    /// Places that the camera must see to see it [m].
    pub outline: Vec<Vec3>,
}

/// What depends on all layers and surfaces together.
pub(super) struct Framed {
    pub panes: Vec<Pane>,
    /// Places that the camera must see to see each layer [m].
    pub outlines: Vec<Vec<Vec3>>,
    /// The same with the strays; empty where there is none.
    pub strays: Vec<Vec<Vec3>>,
    /// The box around everything [m].
    pub extent: [Range; 3],
}

impl Page {
    /// Times at which anything changes [s]: those of grains, where there are any.
    pub(super) fn times(&self) -> Vec<f64> {
        let grains = |l: &&PageLayer| l.role == Role::Grains && !l.frames.is_empty();
        let any = self.layers.iter().any(|l| grains(&l));
        let of = self.layers.iter().filter(|l| !any || grains(l));
        let mut times: Vec<f64> = of.flat_map(|l| l.frames.iter().map(|f| f.time)).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        if times.is_empty() { vec![0.0] } else { times }
    }

    pub(super) fn framed(&self) -> Framed {
        let times = self.times();
        let moments: Vec<f64> = times.iter().copied().step_by(times.len().div_ceil(MOMENTS)).collect();
        let on_its_way = |places: &[Vec3], motion: &Motion| {
            let mut outline = Outline::default();
            add_moving(&mut outline, places, motion, &moments);
            outline.points()
        };
        let layers = self.layers.iter().map(|l| on_its_way(&l.outline.points(), &l.motion));
        let outlines: Vec<Vec<Vec3>> = layers.collect();
        let with_strays = |l: &PageLayer| {
            let mut whole = l.outline.clone();
            whole.add(&l.strays.points());
            let places = whole.points();
            if places == l.outline.points() { Vec::new() } else { on_its_way(&places, &l.motion) }
        };
        let strays = self.layers.iter().map(with_strays).collect();
        let mut all: Vec<Vec3> = outlines.concat();
        let is_mesh = |s: &WallSurface| matches!(s.shape, SurfaceShape::Mesh(_));
        let nothing_else = all.is_empty() && !self.surfaces.iter().any(is_mesh);
        let mut panes = Vec::new();
        for sheet in sheet::sheets(&self.surfaces, sheet::box_of(&all)) {
            let mut own = Outline::default();
            // A plane goes on for ever: it is looked at only where there is nothing else.
            let mesh = matches!(sheet.surface.shape, SurfaceShape::Mesh(_));
            if mesh || (sheet.whole && nothing_else) {
                own.add(&sheet.vertices);
            }
            let outline = on_its_way(&own.points(), &sheet.surface.motion);
            all.extend(&outline);
            panes.push(Pane::new(&sheet, outline));
        }
        Framed { panes, extent: sheet::box_of(&all), outlines, strays }
    }
}

/// Bytes that a surface takes, without its lines.
pub(super) fn bytes(surface: &WallSurface) -> usize {
    match &surface.shape {
        SurfaceShape::Plane(_) => 0,
        SurfaceShape::Mesh(mesh) => 12 * (mesh.vertices.len() + mesh.faces.len()),
    }
}

/// Takes in places on their way.
fn add_moving(outline: &mut Outline, places: &[Vec3], motion: &Motion, moments: &[f64]) {
    let moments = if motion.moves() { moments } else { &[0.0] };
    for &time in moments {
        let pose = motion.pose(time);
        let moved: Vec<Vec3> = places.iter().map(|place| pose.position(place)).collect();
        outline.add(&moved);
    }
}

impl Pane {
    fn new(sheet: &sheet::Sheet, outline: Vec<Vec3>) -> Pane {
        let origin = sheet.vertices.first().copied().unwrap_or_default();
        let packed = |places: &mut dyn Iterator<Item = Vec3>| {
            let numbers = places.flat_map(|p| <[f64; 3]>::from(p - origin));
            Arc::new(numbers.flat_map(|c| (c as f32).to_le_bytes()).collect::<Vec<u8>>())
        };
        Pane {
            outline,
            name: sheet.surface.name.clone(),
            motion: sheet.surface.motion.clone(),
            origin,
            vertices: packed(&mut sheet.vertices.iter().copied()),
            faces: Arc::new(sheet.faces.iter().flatten().flat_map(|n| n.to_le_bytes()).collect()),
            parts: parts(&sheet.parts),
            lines: packed(&mut sheet.lines.iter().flatten().copied()),
            ink: sheet.ink,
            normal: match &sheet.surface.shape {
                SurfaceShape::Plane(plane) => Some(plane.normal),
                SurfaceShape::Mesh(_) => None,
            },
        }
    }
}

/// Numbers of faces, unless each is that of its place.
fn parts(numbers: &[u32]) -> Option<Arc<Vec<u8>>> {
    let moved = numbers.iter().zip(0..).any(|(number, place)| *number != place);
    moved.then(|| Arc::new(numbers.iter().flat_map(|n| n.to_le_bytes()).collect()))
}

/// A place or direction in the page's header.
pub(super) fn triple(v: &Vec3) -> [f64; 3] {
    [v.x, v.y, v.z]
}

/// A motion in the page's header; nothing for what rests.
pub(super) fn motion(motion: &Motion) -> Value {
    if motion.moves() { record::motion_to_json(motion) } else { Value::Null }
}

//! Contact histories of the runs that particles come from: which wall of the scene, and which element of it, was the one of the run.
//!
//! An element (a sphere, a plane, a triangle) is the same if it is in the same place, as it was at t = 0 of the run or where its motion had taken it in the last
//! frame; the order of elements, of walls and of files does not count. A wall that was moved or turned as a whole is known by its name, or by its form.

use crate::input::RunContacts;
use crate::plan::builder::PlanBuilder;
use dem::setup::{KeptContact, KeptPartner, Wall, WallElement, WallShape};
use geom::motion::Pose;
use geom::{Boxes, Plane, Vec3, counted_as};
use std::collections::BTreeMap;

/// Rounding of coordinates in files, over the largest of them [–].
const ROUNDING: f64 = 1e-6;
/// A wall is on the same side of a grain as another one above this cosine [–].
const SAME_SIDE: f64 = 0.9;

impl PlanBuilder<'_> {
    /// Histories that contacts have from the runs that particles come from; a warning counts those that were lost.
    pub(in crate::plan) fn kept(&mut self) -> Vec<KeptContact> {
        let mut all = Vec::new();
        let walls = if self.read.kept.iter().any(|run| !run.walls.is_empty()) {
            SceneWalls::new(&self.walls)
        } else {
            SceneWalls::default()
        };
        for run in &self.read.kept {
            let mut finder = Finder::new(run, &walls);
            let mut lost: BTreeMap<u32, usize> = BTreeMap::new();
            for contact in &run.contacts {
                let KeptPartner::Wall { wall, element } = contact.partner else {
                    all.push(*contact);
                    continue;
                };
                match finder.find(wall as usize, element as usize) {
                    Some((wall, element)) => {
                        let partner = KeptPartner::Wall { wall, element };
                        all.push(KeptContact { partner, ..*contact });
                    }
                    None if finder.is_replaced(contact.id, wall as usize, element as usize) => {
                        *lost.entry(wall).or_default() += 1;
                    }
                    None => {}
                }
            }
            self.warnings.extend(lost_histories(run, &lost));
        }
        all
    }
}

/// What is said of contacts that lose their history, by wall of the run.
fn lost_histories(run: &RunContacts, lost: &BTreeMap<u32, usize>) -> Option<String> {
    let count: usize = lost.values().sum();
    let (first, _) = lost.iter().next()?;
    let of = run.contacts.iter().filter(|contact| contact.is_of_wall()).count();
    let name = &run.walls[*first as usize].name;
    let others = if lost.len() > 1 { format!(" and of {} more", lost.len() - 1) } else { String::new() };
    let begin = counted_as(count, "contact", ["begins", "begin"]);
    Some(format!(
        "{}: {begin} without history, of {of} with walls: the scene has another wall where wall '{name}'{others} was; give the walls the shapes and places \
         that they had in that run, or let the grains settle again",
        run.source
    ))
}

/// Whether a name is not the user's: it tells where in a scene the wall stood.
fn is_numbered(name: &str) -> bool {
    ["wall.", "given", "particles."].iter().any(|start| name.starts_with(start))
}

/// Elements of a wall, as at t = 0.
struct Elements {
    all: Vec<WallElement>,
    /// A point of each that does not depend on the order of its corners [m].
    middles: Vec<Vec3>,
}

impl Elements {
    fn new(shape: &WallShape) -> Elements {
        let all = shape.elements();
        let middles = all.iter().map(middle).collect();
        Elements { all, middles }
    }

    /// Whether this is the other wall, as a whole moved or turned: all elements are of one size, and at one distance from the first two.
    fn is_moved(&self, other: &Elements, tolerance: f64) -> bool {
        let apart = |of: &Elements, k: usize, from: usize| (of.middles[k] - of.middles[from]).norm();
        let second = usize::from(self.all.len() > 1);
        let alike = |k: usize| {
            let sizes = sizes(&self.all[k]).into_iter().zip(sizes(&other.all[k]));
            let places = [0, second].map(|from| (apart(self, k, from), apart(other, k, from)));
            sizes.chain(places).all(|(a, b)| (a - b).abs() <= tolerance)
        };
        let kind = |of: &Elements| of.all.first().map(std::mem::discriminant);
        self.all.len() == other.all.len() && kind(self) == kind(other) && (0..self.all.len()).all(alike)
    }
}

fn middle(element: &WallElement) -> Vec3 {
    match element {
        WallElement::Sphere(centre, _) => *centre,
        WallElement::Plane(plane) => plane.point,
        WallElement::Triangle([a, b, c]) => (a + b + c) / 3.0,
    }
}

/// Lengths that a motion does not change [m].
fn sizes(element: &WallElement) -> [f64; 3] {
    match element {
        WallElement::Sphere(_, radius) => [*radius; 3],
        WallElement::Plane(_) => [0.0; 3],
        WallElement::Triangle([a, b, c]) => [(a - b).norm(), (b - c).norm(), (c - a).norm()],
    }
}

fn bounds(element: &WallElement) -> [Vec3; 2] {
    match element {
        WallElement::Sphere(centre, radius) => [-*radius, *radius].map(|r| centre + Vec3::repeat(r)),
        WallElement::Plane(plane) => [plane.point; 2],
        WallElement::Triangle([a, b, c]) => [a.inf(b).inf(c), a.sup(b).sup(c)],
    }
}

fn moved(element: &WallElement, pose: &Pose) -> WallElement {
    match element {
        WallElement::Sphere(centre, radius) => WallElement::Sphere(pose.position(centre), *radius),
        WallElement::Plane(plane) => WallElement::Plane(Plane {
            point: pose.position(&plane.point),
            normal: pose.direction(&plane.normal),
        }),
        WallElement::Triangle(corners) => WallElement::Triangle(corners.map(|c| pose.position(&c))),
    }
}

/// Whether two elements are in one place.
fn same(a: &WallElement, b: &WallElement, tolerance: f64) -> bool {
    let near = |a: &Vec3, b: &Vec3| (a - b).norm() <= tolerance;
    match (a, b) {
        (WallElement::Sphere(p, r), WallElement::Sphere(q, s)) => near(p, q) && (r - s).abs() <= tolerance,
        (WallElement::Plane(p), WallElement::Plane(q)) => {
            (p.normal - q.normal).norm() <= ROUNDING && p.signed_distance(&q.point).abs() <= tolerance
        }
        (WallElement::Triangle(p), WallElement::Triangle(q)) => {
            let orders = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];
            orders.iter().any(|order| (0..3).all(|k| near(&p[k], &q[order[k]])))
        }
        _ => false,
    }
}

/// The walls of the scene.
#[derive(Default)]
struct SceneWalls {
    names: Vec<String>,
    walls: Vec<Elements>,
    /// Wall and element of each sphere and triangle, and the boxes that hold them.
    bounded: Vec<(u32, u32)>,
    boxes: Option<Boxes>,
    /// Walls that are planes.
    planes: Vec<u32>,
    /// What counts as one place [m].
    tolerance: f64,
}

impl SceneWalls {
    fn new(walls: &[Wall]) -> SceneWalls {
        let names = walls.iter().map(|w| w.name.clone()).collect();
        let walls: Vec<Elements> = walls.iter().map(|w| Elements::new(&w.shape)).collect();
        let is_plane = |w: &Elements| matches!(w.all.first(), Some(WallElement::Plane(_)));
        let planes = (0..).zip(&walls).filter(|(_, w)| is_plane(w)).map(|(w, _)| w).collect();
        let places =
            |(w, of): (u32, &Elements)| (0..of.all.len() as u32).map(move |k| (w, k)).collect::<Vec<_>>();
        let bounded: Vec<(u32, u32)> =
            (0u32..).zip(&walls).filter(|(_, w)| !is_plane(w)).flat_map(places).collect();
        let around: Vec<[Vec3; 2]> =
            bounded.iter().map(|&(w, k)| bounds(&walls[w as usize].all[k as usize])).collect();
        let boxes = (!around.is_empty()).then(|| Boxes::new(&around));
        let all = walls.iter().flat_map(|w| &w.middles);
        let tolerance = ROUNDING * all.map(|p| p.amax()).fold(0.0, f64::max);
        SceneWalls { names, walls, bounded, boxes, planes, tolerance }
    }

    /// Elements within `reach` [m] of a place, and planes.
    fn near(&self, place: Vec3, reach: f64) -> Vec<(u32, u32)> {
        let mut found: Vec<(u32, u32)> = self.planes.iter().map(|&wall| (wall, 0)).collect();
        if let Some(boxes) = &self.boxes {
            boxes.near(place, reach, |k| found.push(self.bounded[k as usize]));
        }
        found.sort_unstable();
        found
    }

    fn element(&self, (wall, k): (u32, u32)) -> &WallElement {
        &self.walls[wall as usize].all[k as usize]
    }

    /// The element in that place; of the wall `only`, if there is one.
    fn at(&self, element: &WallElement, only: Option<u32>) -> Option<(u32, u32)> {
        let mut near = self.near(middle(element), 2.0 * self.tolerance).into_iter();
        near.find(|at| {
            only.is_none_or(|only| only == at.0) && same(self.element(*at), element, self.tolerance)
        })
    }
}

/// Finds the elements of one run among the walls of the scene.
struct Finder<'a> {
    run: &'a RunContacts,
    scene: &'a SceneWalls,
    walls: Vec<Elements>,
    /// Walls of the scene that are those of the run, moved as a whole; by wall of the run, once it is known.
    moved: BTreeMap<usize, Option<u32>>,
}

impl<'a> Finder<'a> {
    fn new(run: &'a RunContacts, scene: &'a SceneWalls) -> Finder<'a> {
        let walls = run.walls.iter().map(|w| Elements::new(&w.shape)).collect();
        Finder { run, scene, walls, moved: BTreeMap::new() }
    }

    /// An element of the run at t = 0, and where its motion had taken it.
    fn places(&self, wall: usize, element: usize) -> Option<[WallElement; 2]> {
        let home = self.walls.get(wall)?.all.get(element)?;
        Some([*home, moved(home, &self.run.walls[wall].pose)])
    }

    /// Wall and element of the scene.
    fn find(&mut self, wall: usize, element: usize) -> Option<(u32, u32)> {
        let places = self.places(wall, element)?;
        let named = self.named(wall);
        let at = |only: Option<u32>| places.iter().find_map(|place| self.scene.at(place, only));
        let here = match named {
            Some(named) => at(Some(named)).or_else(|| at(None)),
            None => at(None),
        };
        here.or_else(|| self.moved(wall).map(|to| (to, element as u32)))
    }

    /// The wall of the scene that has the name.
    fn named(&self, wall: usize) -> Option<u32> {
        let name = &self.run.walls[wall].name;
        let at = self.scene.names.iter().position(|n| n == name && !is_numbered(n));
        at.map(|w| w as u32)
    }

    /// The wall of the scene that is this one, moved as a whole.
    fn moved(&mut self, wall: usize) -> Option<u32> {
        if let Some(known) = self.moved.get(&wall) {
            return *known;
        }
        let was = &self.walls[wall];
        let is_moved = |w: &u32| was.is_moved(&self.scene.walls[*w as usize], self.scene.tolerance);
        // Any plane is another one, moved.
        let found = match (self.named(wall), &self.run.walls[wall].shape) {
            (Some(named), _) => Some(named).filter(is_moved),
            (None, WallShape::Plane(_)) => None,
            (None, _) => (0..self.scene.walls.len() as u32).find(is_moved),
        };
        self.moved.insert(wall, found);
        found
    }

    /// Whether a grain whose wall is not in the scene touches another one there: a wall that was taken away leaves no contact.
    fn is_replaced(&self, id: u32, wall: usize, element: usize) -> bool {
        let Ok(at) = self.run.grains.binary_search_by_key(&id, |grain| grain.0) else { return true };
        let (_, centre, radius) = self.run.grains[at];
        let Some([home, last]) = self.places(wall, element) else { return true };
        let reach = radius * (1.0 + ROUNDING);
        let touches = |e: &WallElement| Some(toward(e, &centre)).filter(|way| way.norm() <= reach);
        let before: Vec<Vec3> = [home, last].iter().filter_map(touches).collect();
        let beside = |way: &Vec3| before.iter().any(|b| b.dot(way) > SAME_SIDE * b.norm() * way.norm());
        let near = self.scene.near(centre, reach);
        let mut touched = near.into_iter().filter_map(|at| touches(self.scene.element(at)));
        touched.any(|way| before.is_empty() || beside(&way))
    }
}

/// From a place to the nearest point of an element [m].
fn toward(element: &WallElement, centre: &Vec3) -> Vec3 {
    match element {
        WallElement::Sphere(middle, radius) => {
            let way = middle - centre;
            way * (1.0 - radius / way.norm().max(f64::MIN_POSITIVE))
        }
        WallElement::Plane(plane) => -plane.normal * plane.signed_distance(centre),
        WallElement::Triangle(corners) => geom::triangle::closest_point(*corners, *centre) - centre,
    }
}

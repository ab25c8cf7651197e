//! The outlines and arrows of a scene.

use dem::setup::{Wall, WallShape, Zone};
use geom::shape::Shape;
use geom::{Plane, Vec3};
use scene::{Plan, Scene};
use view::{Line, OutlineKind, SurfaceShape, WallSurface};

/// Radius of a line over the size of the scene [–]; later positions have half of it.
const LINE: f64 = 1.1e-3;
/// Radius that arrows go by, over the size of the scene: the longest are five of it [–].
const ARROW: f64 = 0.02;
/// Half the side of the square of an unbounded plane that grains pass, over the size of the scene [–].
const SQUARE: f64 = 0.15;
/// Later positions of walls that move: these shares of the time until the end.
const LATER: [f64; 3] = [1.0 / 3.0, 2.0 / 3.0, 1.0];
/// They are drawn where the wall is farther from its first position than this share of the size of the scene [–].
const NEAR: f64 = 0.02;
/// Arrows on a wall that moves, at most.
const ON_A_WALL: usize = 12;
/// Velocities of walls are means over this time from the start [s].
const SOON: f64 = 1e-6;

/// What a scene will do, and the box around it.
pub struct Drawing<'a> {
    scene: &'a Scene,
    plan: &'a Plan,
    fills: Vec<Shape>,
    inserts: Vec<Shape>,
    removals: Vec<Shape>,
    /// Corners of the box around everything with an end [m].
    corners: [Vec3; 2],
}

/// The surface of a wall that is a plane or a mesh.
pub fn surface(wall: &Wall) -> Option<SurfaceShape> {
    match &wall.shape {
        WallShape::Spheres(_) => None,
        WallShape::Plane(plane) => Some(SurfaceShape::Plane(*plane)),
        WallShape::Mesh(mesh) => Some(SurfaceShape::Mesh(mesh.clone())),
    }
}

impl<'a> Drawing<'a> {
    /// Reads the shapes again that the scene names.
    pub fn of(scene: &'a Scene, plan: &'a Plan) -> anyhow::Result<Drawing<'a>> {
        let shape = |text: &str| Shape::parse(text, &mesh::Files(&scene.folder));
        let fills = scene.keys.fill.iter().map(|f| shape(&f.shape)).collect::<Result<Vec<_>, _>>()?;
        let inserts = scene.keys.insert.iter().map(|i| shape(&i.shape)).collect::<Result<Vec<_>, _>>()?;
        let removals = scene.keys.remove.iter().map(|r| shape(&r.shape)).collect::<Result<Vec<_>, _>>()?;
        let mut drawing = Drawing { scene, plan, fills, inserts, removals, corners: [Vec3::zeros(); 2] };
        drawing.corners = drawing.around();
        Ok(drawing)
    }

    /// The box around grains, shapes, wall spheres, meshes and periodic faces.
    fn around(&self) -> [Vec3; 2] {
        let setup = &self.plan.setup;
        let mut places: Vec<Vec3> = setup.particles.iter().map(|p| p.position).collect();
        places.extend(setup.clumps.placed.iter().map(|body| body.position));
        let shapes = self.fills.iter().chain(&self.inserts).chain(&self.removals).flat_map(view::shape_lines);
        places.extend(shapes.flatten());
        for wall in &setup.walls {
            match &wall.shape {
                WallShape::Spheres(all) => places.extend(all.iter().map(|(place, _)| *place)),
                WallShape::Mesh(mesh) => places.extend(&mesh.vertices),
                WallShape::Plane(plane) => places.push(plane.point),
            }
        }
        let own = |zone: &Zone| zone.plane.point;
        places.extend(setup.inlets.iter().map(own));
        let first = places.first().copied().unwrap_or_default();
        let (mut low, mut high) =
            places.iter().fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)));
        for (k, ends) in setup.periodic.iter().enumerate() {
            (low[k], high[k]) = ends.unwrap_or((low[k], high[k]));
        }
        if (high - low).norm() > 0.0 { [low, high] } else { [low.add_scalar(-0.5), high.add_scalar(0.5)] }
    }

    fn size(&self) -> f64 {
        (self.corners[1] - self.corners[0]).norm()
    }

    /// Radius of the lines of a kind [m].
    pub fn line_radius(&self, kind: OutlineKind) -> f64 {
        let share = if kind == OutlineKind::Later { 0.5 } else { 1.0 };
        share * LINE * self.size()
    }

    /// Radius that arrows go by [m].
    pub fn arrow_radius(&self) -> f64 {
        ARROW * self.size()
    }

    /// What is there of each kind: its name in the legend, and its lines.
    pub fn outlines(&self) -> Vec<(OutlineKind, String, Vec<Line>)> {
        use OutlineKind::{Fill, Inlet, Insert, Later, Outlet, Periodic, Remove};
        let setup = &self.plan.setup;
        let lines = |of: &[Shape]| of.iter().flat_map(view::shape_lines).collect::<Vec<Line>>();
        let squares = |zones: &[Zone]| zones.iter().flat_map(|zone| self.square(zone)).collect::<Vec<Line>>();
        // The zones of insertions follow those of the inlets.
        let inlets = &setup.inlets[..self.plan.inlets.len().min(setup.inlets.len())];
        let (count, later) = (setup.outlets.len(), self.later());
        let all = [
            (Fill, geom::counted(self.fills.len(), "fill"), lines(&self.fills)),
            (Insert, geom::counted(self.inserts.len(), "insert"), lines(&self.inserts)),
            (Inlet, geom::counted(inlets.len(), "inlet"), squares(inlets)),
            (Outlet, geom::counted(count, "outlet plane"), squares(&setup.outlets)),
            (Remove, geom::counted(self.removals.len(), "removal shape"), lines(&self.removals)),
            (Periodic, format!("periodic along {}", self.periodic_axes()), self.periodic()),
            (Later, self.words_of_later(), later),
        ];
        all.into_iter().filter(|(.., lines)| !lines.is_empty()).collect()
    }

    fn square(&self, zone: &Zone) -> Vec<Line> {
        let middle = 0.5 * (self.corners[0] + self.corners[1]);
        let plane = &zone.plane;
        let is_near = (plane.point - middle).norm() < self.size();
        let point = if is_near { plane.point } else { plane.project(&middle) };
        view::plane_lines(&Plane { point, ..*plane }, SQUARE * self.size())
    }

    fn periodic_axes(&self) -> String {
        let axes = ["x", "y", "z"].into_iter().zip(&self.plan.setup.periodic);
        axes.filter(|(_, ends)| ends.is_some()).map(|(axis, _)| axis).collect::<Vec<_>>().join(", ")
    }

    fn periodic(&self) -> Vec<Line> {
        let [low, high] = self.corners;
        let any = self.plan.setup.periodic.iter().any(Option::is_some);
        if any { view::box_lines(low, high) } else { Vec::new() }
    }

    /// Times of later positions [s].
    fn times(&self) -> Vec<f64> {
        let end = self.scene.keys.time.until.unwrap_or(0.0);
        LATER.iter().map(|share| share * end).filter(|time| *time > 0.0).collect()
    }

    fn words_of_later(&self) -> String {
        let times: Vec<String> = self.times().iter().map(|time| three_digits(*time)).collect();
        format!("walls at t = {} s", times.join(", "))
    }

    /// Walls that are farther away from where they start than a share of the scene: a screen that vibrates would cover itself.
    fn later(&self) -> Vec<Line> {
        let mut lines = Vec::new();
        for wall in self.plan.setup.walls.iter().filter(|wall| wall.motion.moves()) {
            let now = self.wall_at(wall, 0.0);
            for time in self.times() {
                let then = self.wall_at(wall, time);
                let way = now.iter().flatten().zip(then.iter().flatten()).map(|(a, b)| (b - a).norm());
                if way.fold(0.0, f64::max) > NEAR * self.size() {
                    lines.extend(then);
                }
            }
        }
        lines
    }

    fn wall_at(&self, wall: &Wall, time: f64) -> Vec<Line> {
        match surface(wall) {
            Some(shape) => {
                let surface = WallSurface { name: wall.name.clone(), shape, motion: wall.motion.clone() };
                view::wall_lines(&surface, self.corners, time)
            }
            None => box_of_spheres(wall, time),
        }
    }

    /// Velocities [m/s] at the start of walls and belts, and of what comes in, each at a point [m].
    pub fn arrows(&self) -> Vec<(Vec3, Vec3)> {
        let walls = self.plan.setup.walls.iter();
        let on_walls = walls.filter(|w| w.surface.moves() || w.motion.moves()).flat_map(|w| self.on_wall(w));
        let inserts = self.inserts.iter().zip(&self.scene.keys.insert);
        let of_inserts = inserts.filter_map(|(shape, insert)| {
            let ends: Vec<Vec3> = view::shape_lines(shape).into_iter().flatten().collect();
            let first = ends.first().copied()?;
            let (low, high) = ends.iter().fold((first, first), |(a, b), p| (a.inf(p), b.sup(p)));
            Some((0.5 * (low + high), Vec3::from(insert.velocity)))
        });
        on_walls.chain(of_inserts).collect()
    }

    fn on_wall(&self, wall: &Wall) -> Vec<(Vec3, Vec3)> {
        let places: Vec<Vec3> = match &wall.shape {
            WallShape::Spheres(all) => all.iter().map(|(place, _)| *place).collect(),
            WallShape::Mesh(mesh) => mesh.triangles().map(|[a, b, c]| (a + b + c) / 3.0).collect(),
            WallShape::Plane(plane) => {
                let [low, high] = self.corners;
                let at = |n: usize| {
                    Vec3::from_fn(|k, _| low[k] + (high[k] - low[k]) * THIRDS[n / 3usize.pow(k as u32) % 3])
                };
                (0..9).map(|n| plane.project(&at(n))).collect()
            }
        };
        let step = places.len().div_ceil(ON_A_WALL).max(1);
        let surface = &wall.surface;
        let after = wall.motion.pose(SOON);
        let velocity = |p: &Vec3| {
            let own = surface.velocity + surface.turn.cross(&(p - surface.through));
            own + (after.position(p) - p) / SOON
        };
        let arrows = places.iter().step_by(step).map(|p| (*p, velocity(p)));
        arrows.filter(|(_, velocity)| *velocity != Vec3::zeros()).collect()
    }
}

/// A time to read.
fn three_digits(time: f64) -> String {
    let rounded: f64 = format!("{time:.2e}").parse().unwrap_or(time);
    geom::Shown(rounded).to_string()
}

/// Places between two ends [–].
const THIRDS: [f64; 3] = [1.0 / 6.0, 0.5, 5.0 / 6.0];

/// The box around the spheres of a wall, moved with it.
fn box_of_spheres(wall: &Wall, time: f64) -> Vec<Line> {
    let WallShape::Spheres(all) = &wall.shape else { return Vec::new() };
    let Some((first, _)) = all.first() else { return Vec::new() };
    let (low, high) = all
        .iter()
        .fold((*first, *first), |(a, b), (p, r)| (a.inf(&p.add_scalar(-*r)), b.sup(&p.add_scalar(*r))));
    let pose = wall.motion.pose(time);
    view::box_lines(low, high).into_iter().map(|line| line.map(|p| pose.position(&p))).collect()
}

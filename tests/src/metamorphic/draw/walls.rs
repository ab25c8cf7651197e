//! Walls at the faces of the grid: every form, and every way in which a wall moves.

use super::{CELL, Draw, TIME, digits};
use crate::metamorphic::scene::File;

const AXES: [&str; 3] = ["x", "y", "z"];

/// A face of the grid.
#[derive(Debug, Clone, Copy)]
struct Face {
    axis: usize,
    /// Whether it is the upper one.
    upper: bool,
    /// Where it is on its axis [m].
    at: f64,
}

impl Face {
    /// A vector along the normal, which points to the grains.
    fn inward(self, size: f64) -> [f64; 3] {
        let mut n = [0.0; 3];
        n[self.axis] = if self.upper { -size } else { size };
        n
    }

    fn name(self) -> String {
        format!("{}{}", AXES[self.axis], if self.upper { "+" } else { "-" })
    }
}

impl Draw {
    /// A wall at some of the faces.
    pub(super) fn walls(&mut self) {
        let (low, high, periodic) = (self.choices.low, self.high(), self.choices.periodic);
        let mut boxed = Vec::new();
        for axis in (0..3).filter(|k| !periodic[*k]) {
            for upper in [false, true] {
                let above = self.choices.inserted && axis == 2 && upper;
                let often = self.choices.plain && periodic != [false; 3];
                if above
                    || !self.chance(if upper {
                        0.35
                    } else if often {
                        0.95
                    } else {
                        0.7
                    })
                {
                    continue;
                }
                // A face that cuts into the outermost grains would push them at once: it lies at theirs or a little outside.
                let away = if self.chance(0.5) { 0.0 } else { self.between(0.0, 5e-4) };
                let at = if upper { high[axis] + away } else { low[axis] - away };
                let face = Face { axis, upper, at: digits(at, 9) };
                match if often { self.pick(&[0, 0, 0, 1, 2]) } else { self.pick(&[0, 1, 2, 2, 2, 3, 4, 5]) } {
                    0 => self.plane(face),
                    1 => boxed.push(face),
                    2 => self.mesh(face),
                    3 => self.plate(face),
                    4 => self.spheres(face),
                    _ => self.solid(face),
                }
            }
        }
        if !boxed.is_empty() {
            self.boxes(&boxed, low, high);
        }
    }

    fn head(&mut self, lines: &str) {
        let material = self.pick(&["a", "b"]);
        self.line(format!("[[wall]]\n{lines}\nmaterial = \"{material}\""));
        if self.chance(0.6) {
            let name = format!("wall-{}", self.text.len());
            self.line(format!("name = \"{name}\""));
        }
    }

    fn plane(&mut self, face: Face) {
        let mut point = [0.0; 3];
        point[face.axis] = face.at;
        self.head(&format!("plane = {:?}", [point, face.inward(1.0)].concat()));
        match self.pick(&[0, 1, 2, 3, 4, 5, 6]) {
            0 => self.motion(face, true),
            1 | 2 => self.belt(face),
            3 => self.mount(face),
            _ => {}
        }
    }

    fn boxes(&mut self, faces: &[Face], low: [f64; 3], high: [f64; 3]) {
        let beyond = self.pick(&[0.02, 0.0, -0.006]);
        let (mut low, mut high) = (low.map(|x| digits(x - beyond, 9)), high.map(|x| digits(x + beyond, 9)));
        // Faces that repeat end where their image begins.
        for k in (0..3).filter(|k| self.choices.periodic[*k]) {
            (low[k], high[k]) = (self.choices.low[k], self.high()[k]);
        }
        for face in faces {
            (if face.upper { &mut high } else { &mut low })[face.axis] = face.at;
        }
        let names: Vec<String> = faces.iter().map(|f| f.name()).collect();
        self.head(&format!("box = {:?}\nfaces = {names:?}", [low, high].concat()));
        if let ([face], true) = (faces, self.chance(0.3)) {
            self.mount(*face);
        } else if self.chance(0.3) {
            let v = self.vector(0.2);
            self.line(format!("motion = {{ translate = {v:?} }}"));
        }
    }

    /// Corners of a face: its lowest and highest one. It ends where the domain repeats.
    fn corners(&self, face: Face, beyond: f64) -> [[f64; 2]; 2] {
        let (low, high) = (self.choices.low, self.high());
        let others = [(face.axis + 1) % 3, (face.axis + 2) % 3];
        others.map(|k| {
            let beyond = if self.choices.periodic[k] { 0.0 } else { beyond };
            [digits(low[k] - beyond, 9), digits(high[k] + beyond, 9)]
        })
    }

    fn mesh(&mut self, face: Face) {
        let [u, v] = self.corners(face, 0.5 * CELL);
        let cells: usize = self.pick(&[1, 1, 2, 3, 4]);
        // A seam across the first axis behind the plane: a shallow valley.
        let fold = if cells.is_multiple_of(2) && self.chance(0.5) { self.between(0.0, 0.004) } else { 0.0 };
        let inward = face.inward(1.0)[face.axis];
        let mut vertices = Vec::new();
        for j in 0..=cells {
            for i in 0..=cells {
                let part = |[low, high]: [f64; 2], k: usize| low + (high - low) * k as f64 / cells as f64;
                let mut p = [0.0; 3];
                p[face.axis] = face.at + if i * 2 == cells { -fold * inward } else { 0.0 };
                p[(face.axis + 1) % 3] = part(u, i);
                p[(face.axis + 2) % 3] = part(v, j);
                vertices.push(p.map(|x| digits(x, 9)));
            }
        }
        let mut triangles = Vec::new();
        for j in 0..cells {
            for i in 0..cells {
                let at = |i: usize, j: usize| j * (cells + 1) + i;
                let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                if self.chance(0.5) {
                    triangles.extend([[a, b, c], [a, c, d]]);
                } else {
                    triangles.extend([[a, b, d], [b, c, d]]);
                }
            }
        }
        let name = self.file("mesh", "ply", File::Mesh(vertices, triangles));
        self.head(&format!("mesh = \"{name}\""));
        let factor = self.pick(&["units = \"m\"", "scale = 1.0"]);
        self.maybe(0.2, factor);
        match self.pick(&[0, 1, 2, 3, 4, 5]) {
            0 | 1 => self.motion(face, false),
            2 => self.belt(face),
            3 => self.mount(face),
            _ => {}
        }
    }

    /// A box behind the face.
    fn plate(&mut self, face: Face) {
        let [u, v] = self.corners(face, 0.2 * CELL);
        let mut low = [0.0; 3];
        let mut high = [0.0; 3];
        let back = face.at - face.inward(0.004)[face.axis];
        (low[face.axis], high[face.axis]) = (digits(back.min(face.at), 9), digits(back.max(face.at), 9));
        for (k, [a, b]) in [u, v].into_iter().enumerate() {
            let axis = (face.axis + 1 + k) % 3;
            (low[axis], high[axis]) = (a, b);
        }
        self.head(&format!("solid = {{ box = {:?} }}", [low, high].concat()));
        match self.pick(&[0, 1, 2]) {
            0 => self.motion(face, false),
            1 => self.belt(face),
            _ => {}
        }
    }

    /// A layer of fixed grains behind the face.
    fn spheres(&mut self, face: Face) {
        let [u, v] = self.corners(face, 0.0);
        let count = |[a, b]: [f64; 2]| ((b - a) / CELL).round() as usize;
        let mut rows = Vec::new();
        for j in 0..count(v) {
            for i in 0..count(u) {
                let mut p = [0.0; 3];
                p[face.axis] = face.at - face.inward(0.5 * CELL)[face.axis];
                p[(face.axis + 1) % 3] = u[0] + CELL * (i as f64 + 0.5);
                p[(face.axis + 2) % 3] = v[0] + CELL * (j as f64 + 0.5);
                rows.push([p.map(|x| digits(x, 9)).to_vec(), vec![0.5 * CELL]].concat());
            }
        }
        let columns = ["x", "y", "z", "radius"].map(str::to_owned).to_vec();
        let name = self.file("layer", "csv", File::Rows(columns, rows));
        self.line(format!("[[particles]]\nsource = \"{name}\"\nmaterial = \"b\"\nfixed = true"));
    }

    /// A round body behind the face.
    fn solid(&mut self, face: Face) {
        let (low, high) = (self.choices.low, self.high());
        let mut centre = [0, 1, 2].map(|k| digits(0.5 * (low[k] + high[k]), 9));
        let radius = 0.008;
        centre[face.axis] = digits(face.at - face.inward(radius)[face.axis], 9);
        let mut end = centre;
        let along = (face.axis + 1) % 3;
        end[along] = digits(centre[along] + 0.009, 9);
        let shape = match self.pick(&[0, 1, 2]) {
            0 => format!("sphere = {:?}", [&centre[..], &[radius]].concat()),
            1 => format!("cylinder = {:?}", [&centre[..], &end, &[radius]].concat()),
            _ => format!("cone = {:?}", [&centre[..], &end, &[radius, 0.004]].concat()),
        };
        self.head(&format!("solid = {{ {shape} }}"));
        if self.chance(0.4) {
            self.motion(face, false);
        } else if self.chance(0.3) {
            let about = face.inward(1.0);
            let rpm = self.between(-200.0, 200.0);
            self.line(format!(
                "surface_rotation = {{ about = {about:?}, through = {centre:?}, rpm = {rpm:?} }}"
            ));
        }
    }

    fn belt(&mut self, face: Face) {
        if self.chance(0.7) {
            let mut v = self.vector(1.0);
            v[face.axis] = 0.0;
            self.line(format!("surface_velocity = {v:?}"));
        } else {
            let (about, through) = (face.inward(1.0), self.choices.low);
            let rpm = self.between(-200.0, 200.0);
            self.line(format!(
                "surface_rotation = {{ about = {about:?}, through = {through:?}, rpm = {rpm:?} }}"
            ));
        }
    }

    /// A spring or a servo.
    fn mount(&mut self, face: Face) {
        let direction = face.inward(1.0);
        if self.chance(0.5) {
            let (stiffness, damping) = (self.scale(500.0, 5e3), self.scale(0.1, 3.0));
            self.line(format!(
                "spring = {{ direction = {direction:?}, stiffness = {stiffness:?}, damping = {damping:?}, mass = 0.05, speed_limit = 3.0 }}"
            ));
            return;
        }
        let load = match self.pick(&[0, 1, 2, 3]) {
            0 => format!("force = {:?}", self.scale(0.2, 2.0)),
            1 => format!("stress = {:?}, area = 0.001", self.scale(200.0, 2e3)),
            2 => format!("stress = {:?}, area_between = [0.03, 0.04]", self.scale(200.0, 2e3)),
            _ => {
                let rows = vec![vec![0.0, 0.5], vec![0.5 * TIME, 1.0], vec![1.0, 1.0]];
                let file = File::Rows(vec!["t".to_owned(), "force".to_owned()], rows);
                format!("path = {{ source = \"{}\" }}", self.file("load", "csv", file))
            }
        };
        self.line(format!("servo = {{ direction = {direction:?}, {load}, speed_limit = 0.2 }}"));
    }

    /// One motion or a list of them.
    fn motion(&mut self, face: Face, plane: bool) {
        if self.chance(0.6) {
            let one = self.one_motion(face, plane, true);
            self.line(format!("motion = {{ {one} }}"));
        } else {
            let (one, other) = (self.one_motion(face, plane, true), self.one_motion(face, plane, false));
            self.line(format!("motion = [{{ {one} }}, {{ {other} }}]"));
        }
    }

    fn one_motion(&mut self, face: Face, plane: bool, first: bool) -> String {
        let through = self.choices.low;
        let about =
            if plane { face.inward(1.0) } else { self.vector(1.0).map(|x| x + 0.1).map(|x| digits(x, 4)) };
        let mut all = Vec::new();
        match self.pick(&[0, 1, 2, 3, 4]) {
            0 => all.push(format!(
                "rotate = {{ about = {about:?}, through = {through:?}, rpm = {:?} }}",
                self.between(-30.0, 30.0)
            )),
            1 if !plane => all.push(format!(
                "swing = {{ about = {about:?}, through = {through:?}, amplitude = 0.02, frequency = {:?} }}",
                self.between(20.0, 60.0)
            )),
            2 => all.push(format!(
                "vibrate = {{ amplitude = {:?}, frequency = {:?} }}",
                self.vector(2e-4),
                self.between(20.0, 100.0)
            )),
            3 => {
                let columns = ["t", "x", "y", "z"].map(str::to_owned).to_vec();
                let to = self.vector(5e-4).to_vec();
                let rows =
                    vec![vec![0.0; 4], [vec![0.5 * TIME], to.clone()].concat(), [vec![1.0], to].concat()];
                let name = self.file("path", "csv", File::Rows(columns, rows));
                all.push(format!("path = {{ source = \"{name}\" }}"));
            }
            _ => all.push(format!("translate = {:?}", self.vector(0.15))),
        }
        if self.chance(0.3) || !first {
            all.push(format!("from = {:?}", self.between(0.1, 0.3) * TIME));
        }
        if self.chance(0.3) {
            all.push(format!("until = {:?}", self.between(0.5, 0.9) * TIME));
            if self.chance(0.5) {
                all.push(format!("ramp = {:?}", 0.1 * TIME));
            }
        }
        all.join(", ")
    }
}

//! Grains, clumps, bonds and insertions.

use super::{CELL, Draw, TIME, digits};
use crate::metamorphic::scene::File;

/// Columns of the files of grains.
const COLUMNS: [&str; 10] = ["x", "y", "z", "vx", "vy", "vz", "wx", "wy", "wz", "radius"];

impl Draw {
    /// Everything that moves freely.
    pub(super) fn grains(&mut self) {
        if self.choices.clumps {
            self.clumps();
        }
        // A lattice that touches, or places at random, instead of files.
        if self.chance(0.1) {
            self.fill();
        } else {
            self.files();
        }
        if self.choices.inserted {
            self.insertion();
        }
        if self.choices.bonded {
            self.bonds();
        }
    }

    fn files(&mut self) {
        let cells = self.choices.cells;
        let sites = (0..cells[0] * cells[1] * cells[2])
            .map(|k| [k % cells[0], k / cells[0] % cells[1], k / cells[0] / cells[1]])
            .collect::<Vec<_>>();
        let smallest = if self.chance(0.3) { 1.0 } else { 0.75 };
        let (mut grains, mut bodies) = ([Vec::new(), Vec::new()], Vec::new());
        for site in sites {
            if self.chance(0.1) {
                continue;
            }
            if self.choices.clumps && self.chance(0.4) {
                bodies.push(self.state(site, 0.47 * CELL));
                continue;
            }
            let most = if self.choices.dense { 0.5015 } else { 0.47 };
            let radius = digits(CELL * most * self.random_size(smallest), 6);
            let row = [self.state(site, radius), vec![radius]].concat();
            grains[usize::from(self.random_second())].push(row);
        }
        self.bodies(bodies);
        if grains[0].is_empty() {
            let radius = 0.45 * CELL;
            grains[0].push([self.state([0; 3], radius), vec![radius]].concat());
        }
        let clusters = self.choices.bonded && self.chance(0.4);
        for (material, rows) in ["a", "b"].into_iter().zip(grains) {
            if !rows.is_empty() {
                self.one_file(material, rows, clusters);
            }
        }
    }

    fn random_size(&mut self, smallest: f64) -> f64 {
        if self.choices.dense || smallest == 1.0 { 1.0 } else { self.between(smallest, 1.0) }
    }

    fn random_second(&mut self) -> bool {
        self.chance(0.25)
    }

    fn one_file(&mut self, material: &str, rows: Vec<Vec<f64>>, clusters: bool) {
        let mut columns: Vec<String> = COLUMNS.map(str::to_owned).to_vec();
        let mut rows = rows;
        if clusters {
            columns.push("cluster".to_owned());
            for row in &mut rows {
                let cluster = self.pick(&[0.0, 1.0, 2.0]);
                row.push(cluster);
            }
        }
        let several = self.chance(0.1);
        if several {
            columns.push("material".to_owned());
            rows.iter_mut().for_each(|row| row.push(0.0));
        }
        let name = self.file("grains", "csv", File::Rows(columns, rows));
        self.line(format!("[[particles]]\nsource = \"{name}\""));
        self.line(match several {
            true => format!("materials = [\"{material}\"]"),
            false => format!("material = \"{material}\""),
        });
        let factor = self.pick(&["units = \"m\"", "scale = 1.0"]);
        self.maybe(0.2, factor);
        if !clusters && self.choices.bonded {
            self.maybe(0.2, "cluster = 3");
        }
        self.maybe(0.05, "fixed = false");
    }

    /// Position, velocity and spin of what fills a sphere in a cell.
    fn state(&mut self, site: [usize; 3], radius: f64) -> Vec<f64> {
        let slack = (0.5 * CELL - radius).max(0.0);
        let low = self.choices.low;
        let place = [0, 1, 2].map(|k| {
            let off = if slack > 0.0 { self.between(-slack, slack) } else { 0.0 };
            digits(low[k] + CELL * (site[k] as f64 + 0.5) + off, 8)
        });
        let speed = if self.choices.dense { 0.1 } else { 0.5 };
        let (velocity, spin) = (self.vector(speed), self.vector(20.0));
        [place, velocity, spin].concat()
    }

    fn clumps(&mut self) {
        self.line("[[clump]]\nname = \"pair\"\nmaterial = \"a\"");
        let (r, a) = (self.between(0.2, 0.3) * CELL, 0.15 * CELL);
        let (r, a) = (digits(r, 4), digits(a, 4));
        let third = if self.chance(0.5) {
            format!(", [0.0, {a:?}, 0.0, {:?}]", digits(0.8 * r, 4))
        } else {
            String::new()
        };
        self.line(format!("spheres = [[-{a:?}, 0.0, 0.0, {r:?}], [{a:?}, 0.0, 0.0, {r:?}]{third}]"));
        match self.pick(&[0, 1, 2]) {
            0 => self.line("mass = \"sum\""),
            1 => self.line(
                "moments = { volume = 1.5e-7, centre = [0.0, 1e-4, 0.0], inertia = [6e-13, 9e-13, 1e-12, 1e-14, 0.0, 2e-14] }",
            ),
            _ => self.maybe(0.5, "mass = \"union\""),
        }
        self.key(0.2, "scale", 0.8, 1.1);
    }

    fn bodies(&mut self, bodies: Vec<Vec<f64>>) {
        if bodies.is_empty() {
            return;
        }
        let quaternion = |draw: &mut Draw| -> [f64; 4] {
            let q = [0; 4].map(|_| draw.between(-1.0, 1.0));
            let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
            q.map(|x| digits(x / length, 12))
        };
        if self.chance(0.5) {
            for b in &bodies {
                let q = quaternion(self);
                self.line(format!(
                    "[[body]]\nclump = \"pair\"\nposition = {:?}\nvelocity = {:?}\nspin = {:?}",
                    &b[..3],
                    &b[3..6],
                    &b[6..]
                ));
                self.maybe(0.8, format!("quaternion = {q:?}"));
                self.key(0.2, "scale", 0.8, 1.0);
            }
            return;
        }
        let columns = ["x", "y", "z", "vx", "vy", "vz", "wx", "wy", "wz", "qw", "qx", "qy", "qz"];
        let rows = bodies.into_iter().map(|b| [b, quaternion(self).to_vec()].concat()).collect();
        let name = self.file("clumps", "csv", File::Rows(columns.map(str::to_owned).to_vec(), rows));
        self.line(format!("[[particles]]\nsource = \"{name}\"\nclump = \"pair\""));
    }

    fn fill(&mut self) {
        let (low, high) = (self.choices.low, self.high());
        let clump = self.choices.clumps;
        let what = if clump { "clump = \"pair\"" } else { "material = \"a\"" };
        self.line(format!("[[fill]]\n{what}\nshape = {{ box = {:?} }}", [low, high].concat()));
        if clump {
            self.line("count = 4");
            self.key(0.6, "scale", 0.8, 1.0);
        } else if self.chance(0.3) {
            let lattice = self.pick(&["cubic", "hexagonal"]);
            self.line(format!("lattice = \"{lattice}\"\ndiameter = 0.0095"));
        } else {
            self.fill_sizes();
        }
        let velocity = self.vector(0.4);
        self.maybe(0.7, format!("velocity = {velocity:?}"));
        if self.choices.bonded && !clump {
            self.maybe(0.7, "cluster = 2");
        }
    }

    fn fill_sizes(&mut self) {
        match self.pick(&[0, 1, 2]) {
            0 => self.line("diameter = 0.006"),
            1 => self.line("diameter = [0.005, 0.008]"),
            _ => {
                self.line("sizes = [[0.006, 0.5], [0.008, 0.5]]");
                let by = self.pick(&["mass", "number"]);
                self.maybe(0.5, format!("by = \"{by}\""));
            }
        }
        let line = self.pick(&["count = 9", "count = 5", "mass = 0.002"]);
        self.line(line);
        self.maybe(0.3, "seed = 7");
    }

    fn insertion(&mut self) {
        let (low, high) = (self.choices.low, self.high());
        // Above all grains, or where the uppermost of them are.
        let up = if self.chance(0.4) { -0.006 } else { 0.002 };
        let above =
            [low[0], low[1], digits(high[2] + up, 9), high[0], high[1], digits(high[2] + up + 0.012, 9)];
        let clump = self.choices.clumps && self.chance(0.8);
        let what = if clump { "clump = \"pair\"" } else { "material = \"b\"" };
        self.line(format!("[[insert]]\n{what}\nshape = {{ box = {above:?} }}\nvelocity = [0.0, 0.0, -0.8]"));
        if clump {
            self.key(0.4, "scale", 0.8, 1.0);
        } else {
            match self.pick(&[0, 1, 2]) {
                0 => self.line("diameter = 0.007"),
                1 => self.line("diameter = [0.006, 0.008]"),
                _ => {
                    let by = self.pick(&["mass", "number"]);
                    self.line(format!("sizes = [[0.006, 0.5], [0.008, 0.5]]\nby = \"{by}\""));
                }
            }
        }
        let line = self.pick(&["rate_count = 90.0", "rate = 0.02"]);
        self.line(line);
        let line = self.pick(&["count = 3", "mass = 0.003", ""]);
        self.line(line);
        self.key(0.3, "from", 0.05 * TIME, 0.2 * TIME);
        self.key(0.3, "until", 0.5 * TIME, 2.0 * TIME);
        self.maybe(0.3, "seed = 5");
        let when = self.pick(&["wait", "skip"]);
        self.maybe(0.4, format!("when_blocked = \"{when}\""));
    }

    fn bonds(&mut self) {
        let kind = self.pick(&["beam", "parallel", "contact"]);
        let clusters = self.pick(&["any", "any", "any", "any", "any", "same", "different"]);
        self.line(format!("[[bond]]\nbetween = [\"a\", \"a\"]\nclusters = \"{clusters}\"\ngap = 0.0018"));
        self.maybe(if kind == "beam" { 0.5 } else { 1.0 }, format!("kind = \"{kind}\""));
        match (kind, self.chance(0.5)) {
            ("beam", _) => {
                self.key(1.0, "young", 5e5, 5e6);
                self.line("poisson = 0.25");
            }
            (_, true) => {
                self.key(1.0, "modulus", 5e5, 5e6);
                self.key(1.0, "stiffness_ratio", 1.0, 4.0);
            }
            ("parallel", _) => {
                self.key(1.0, "normal_stiffness_per_area", 5e7, 5e8);
                self.key(1.0, "shear_stiffness_per_area", 2e7, 2e8);
            }
            _ => {
                self.key(1.0, "normal_stiffness", 2e3, 2e4);
                self.key(1.0, "shear_stiffness", 1e3, 1e4);
            }
        }
        if kind != "contact" {
            self.key(0.4, "radius_ratio", 0.4, 1.0);
            self.maybe(0.4, "replaces_contact = true");
        }
        if kind == "parallel" {
            self.key(0.4, "moments", 0.2, 1.0);
        }
        self.strengths(kind);
        self.key(0.4, "damping", 0.05, 1.0);
        self.key(0.15, "at", 0.1 * TIME, 0.5 * TIME);
    }

    fn strengths(&mut self, kind: &str) {
        match self.pick(&[0, 1, 2, 3]) {
            _ if self.choices.plain => return,
            0 => return,
            1 if kind == "contact" => {
                self.key(1.0, "tensile_force", 0.5, 20.0);
                self.key(1.0, "shear_force", 0.5, 20.0);
            }
            2 => {
                self.key(1.0, "tensile_strength", 1e3, 1e5);
                self.key(1.0, "strength_ratio", 0.3, 2.0);
            }
            _ => {
                self.key(1.0, "tensile_strength", 1e3, 1e5);
                self.key(1.0, "shear_strength", 1e3, 1e5);
            }
        }
        self.key(0.3, "friction_angle", 0.1, 0.7);
        match self.pick(&[0, 1, 2]) {
            0 => self.line("deviation = 0.2"),
            1 => {
                self.line("weibull_modulus = 4.0");
                self.maybe(0.5, "reference_radius = 0.004");
            }
            _ => {}
        }
        self.maybe(0.3, "seed = 11");
    }
}

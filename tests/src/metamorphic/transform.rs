//! A change of the frame and of the units in which a scene is written: what it makes of numbers, points and vectors, of a scene and of its
//! results.
//!
//! ```text
//! x′ = 2^l (Q x) + s        v′ = 2^(l−t) (Q v) + b        other numbers: × 2^(l a + m b + t c) of their dimension
//! ```

use super::meaning::{Dimension, Kind, Meaning, column, meaning, width};
use super::scene::{File, Scene, number, numbers};
use toml::{Table, Value};

/// The change.
#[derive(Debug, Clone, PartialEq)]
pub struct Transform {
    /// Powers of two of lengths, masses and times.
    pub powers: Dimension,
    /// Q: orthogonal.
    pub turn: [[f64; 3]; 3],
    /// s [m].
    pub shift: [f64; 3],
    /// b [m/s].
    pub boost: [f64; 3],
}

impl Default for Transform {
    fn default() -> Transform {
        let turn = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        Transform { powers: [0; 3], turn, shift: [0.0; 3], boost: [0.0; 3] }
    }
}

const AXES: [&str; 3] = ["x", "y", "z"];

impl Transform {
    /// A power of two for a dimension.
    fn factor(&self, dimension: Dimension) -> f64 {
        2f64.powi((0..3).map(|k| self.powers[k] * dimension[k]).sum())
    }

    /// Whether it turns or mirrors.
    fn turns(&self) -> bool {
        self.turn != Transform::default().turn
    }

    /// +1, or −1 of a mirror.
    fn determinant(&self) -> f64 {
        let [a, b, c] = self.turn;
        let of = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
        a[0] * of(1, 2) - a[1] * of(0, 2) + a[2] * of(0, 1)
    }

    fn turned(&self, v: [f64; 3]) -> [f64; 3] {
        if !self.turns() {
            return v;
        }
        // A sum with zeros is exact, so axes are exchanged without rounding; + 0.0 makes a negative zero positive.
        self.turn.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2] + 0.0)
    }

    fn scaled(&self, v: [f64; 3], dimension: Dimension) -> [f64; 3] {
        let factor = self.factor(dimension);
        self.turned(v).map(|x| x * factor)
    }

    fn point(&self, p: [f64; 3]) -> [f64; 3] {
        let q = self.scaled(p, [1, 0, 0]);
        [0, 1, 2].map(|k| q[k] + self.shift[k])
    }

    /// Three numbers, or one.
    pub fn values(&self, meaning: Meaning, v: &[f64]) -> Vec<f64> {
        let three = |v: &[f64]| [v[0], v[1], v[2]];
        let d = meaning.dimension;
        match meaning.kind {
            Kind::Point => self.point(three(v)).to_vec(),
            Kind::Vector => {
                let boost = if d == [1, 0, -1] { self.boost } else { [0.0; 3] };
                let scaled = self.scaled(three(v), d);
                (0..3).map(|k| scaled[k] + boost[k]).collect()
            }
            Kind::Axial => self.scaled(three(v), d).map(|x| x * self.determinant()).to_vec(),
            Kind::Plane => [self.point(three(v)), self.turned(three(&v[3..]))].concat(),
            Kind::Orientation => self.orientation(v),
            _ => v.iter().map(|x| x * self.factor(d)).collect(),
        }
    }

    /// Q R Qᵀ of a quaternion w x y z. A clump's own frame is turned as well: the real part stays, and the vector part is that of an axis.
    fn orientation(&self, q: &[f64]) -> Vec<f64> {
        let axis = self.turned([q[1], q[2], q[3]]).map(|x| x * self.determinant());
        [vec![q[0]], axis.to_vec()].concat()
    }

    /// Where an axis goes, and whether it is reversed, of a change that exchanges axes.
    pub fn axis(&self, axis: usize) -> (usize, bool) {
        let to = (0..3).find(|k| self.turn[*k][axis].abs() > 0.5).unwrap_or(axis);
        (to, self.turn[to][axis] < 0.0)
    }

    /// The changed scene.
    pub fn scene(&self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        self.table("", &mut scene.keys);
        if let Some(Value::Table(domain)) = scene.keys.get_mut("domain") {
            self.domain(domain);
        }
        for (name, file) in &mut scene.files {
            match file {
                // Paths are relative to their first row.
                File::Rows(columns, rows) => {
                    let relative = name.starts_with("path");
                    rows.iter_mut().for_each(|row| self.row(columns, row, relative));
                }
                File::Mesh(vertices, triangles) => {
                    vertices.iter_mut().for_each(|v| *v = self.point(*v));
                    if self.determinant() < 0.0 {
                        triangles.iter_mut().for_each(|t| t.swap(1, 2));
                    }
                }
            }
        }
        scene
    }

    /// A row of a table whose columns have these names.
    pub fn row<S: AsRef<str>>(&self, columns: &[S], row: &mut [f64], relative: bool) {
        let mut k = 0;
        while k < columns.len() {
            let mut of = column(columns[k].as_ref());
            let wide = width(of).min(columns.len() - k);
            if relative && of.kind == Kind::Point {
                of.kind = Kind::Vector;
            }
            if wide == width(of) {
                let changed = self.values(of, &row[k..k + wide]);
                row[k..k + wide].copy_from_slice(&changed);
            }
            k += wide;
        }
    }

    fn table(&self, path: &str, table: &mut Table) {
        for (key, value) in table.iter_mut() {
            let path = format!("{path}.{key}");
            self.value(path.trim_start_matches('.'), value);
        }
        if self.turns() {
            self.rename_strain(table);
        }
    }

    fn value(&self, path: &str, value: &mut Value) {
        let of = meaning(path);
        match (of.kind, &mut *value) {
            (Kind::Axes, Value::Array(list)) => list.iter_mut().for_each(|axis| self.axis_name(axis)),
            (Kind::Faces, Value::Array(list)) => list.iter_mut().for_each(|face| self.face_name(face)),
            (Kind::Corners, value) => self.corners(value),
            (Kind::Shape, Value::Table(shape)) => shape.iter_mut().for_each(|(name, v)| self.shape(name, v)),
            (Kind::Spheres, Value::Array(list)) => {
                let own = Transform { shift: [0.0; 3], ..self.clone() };
                for sphere in list {
                    let Some(s) = numbers(sphere) else { continue };
                    let centre = own.point([s[0], s[1], s[2]]);
                    *sphere = array(&[&centre[..], &[s[3] * self.factor([1, 0, 0])]].concat());
                }
            }
            (Kind::Moments, Value::Table(moments)) => self.moments(moments),
            (_, Value::Table(table)) => self.table(path, table),
            (_, Value::Array(list)) if list.iter().any(Value::is_table) => {
                list.iter_mut().filter_map(Value::as_table_mut).for_each(|t| self.table(path, t));
            }
            (_, Value::Array(_)) => {
                if let Some(list) = numbers(value) {
                    *value = array(&self.values(of, &list));
                }
            }
            (_, Value::Float(x)) => *x *= self.factor(of.dimension),
            (_, Value::Integer(i)) if of.dimension != [0; 3] && self.powers != [0; 3] => {
                *value = Value::Float(*i as f64 * self.factor(of.dimension));
            }
            _ => {}
        }
    }

    fn shape(&self, name: &str, value: &mut Value) {
        let Some(v) = numbers(value) else { return };
        let points = if name == "sphere" { 1 } else { 2 };
        let mut all: Vec<f64> =
            v.chunks(3).take(points).flat_map(|p| self.point([p[0], p[1], p[2]])).collect();
        all.extend(v[3 * points..].iter().map(|x| x * self.factor([1, 0, 0])));
        if name == "box" {
            sort_corners(&mut all);
        }
        *value = array(&all);
    }

    fn corners(&self, value: &mut Value) {
        let Some(v) = numbers(value) else { return };
        let mut all: Vec<f64> = v.chunks(3).flat_map(|p| self.point([p[0], p[1], p[2]])).collect();
        sort_corners(&mut all);
        *value = array(&all);
    }

    fn moments(&self, moments: &mut Table) {
        let own = Transform { shift: [0.0; 3], ..self.clone() };
        for (key, value) in moments.iter_mut() {
            match (key.as_str(), number(value), numbers(value)) {
                ("volume", Some(v), _) => *value = Value::Float(v * self.factor([3, 0, 0])),
                ("centre", _, Some(c)) => *value = array(&own.point([c[0], c[1], c[2]])),
                ("inertia", _, Some(i)) => {
                    let full = [[i[0], i[3], i[4]], [i[3], i[1], i[5]], [i[4], i[5], i[2]]];
                    let of = |a: usize, b: usize| -> f64 {
                        let term = |k: usize, l: usize| self.turn[a][k] * full[k][l] * self.turn[b][l];
                        (0..3).map(|k| (0..3).map(|l| term(k, l)).sum::<f64>()).sum::<f64>()
                            * self.factor([5, 0, 0])
                    };
                    *value = array(&[of(0, 0), of(1, 1), of(2, 2), of(0, 1), of(0, 2), of(1, 2)]);
                }
                _ => {}
            }
        }
    }

    fn axis_name(&self, value: &mut Value) {
        if let Some(axis) = AXES.iter().position(|a| value.as_str() == Some(a)) {
            *value = AXES[self.axis(axis).0].into();
        }
    }

    fn face_name(&self, value: &mut Value) {
        let Some(name) = value.as_str() else { return };
        let Some(axis) = AXES.iter().position(|a| name.starts_with(a)) else { return };
        let (to, reversed) = self.axis(axis);
        let side = if name.ends_with('+') != reversed { "+" } else { "-" };
        *value = format!("{}{side}", AXES[to]).into();
    }

    /// The tables of `strain` are named after axes.
    fn rename_strain(&self, table: &mut Table) {
        let Some(Value::Table(strain)) = table.get_mut("strain") else { return };
        let old = std::mem::take(strain);
        for (name, value) in old {
            let axis = AXES.iter().position(|a| *a == name);
            strain.insert(axis.map_or(name, |a| AXES[self.axis(a).0].to_owned()), value);
        }
    }

    /// Corners of the domain are points, each number of which is the lower or higher one again.
    fn domain(&self, domain: &mut Table) {
        let of = |domain: &Table, key: &str| domain.get(key).and_then(numbers);
        if let (Some(low), Some(high)) = (of(domain, "low"), of(domain, "high")) {
            let mut both = [low, high].concat();
            sort_corners(&mut both);
            domain.insert("low".to_owned(), array(&both[..3]));
            domain.insert("high".to_owned(), array(&both[3..]));
        }
    }
}

fn sort_corners(both: &mut [f64]) {
    for axis in 0..3 {
        if both[axis] > both[axis + 3] {
            both.swap(axis, axis + 3);
        }
    }
}

/// A list of numbers.
pub fn array(numbers: &[f64]) -> Value {
    Value::Array(numbers.iter().map(|x| Value::Float(*x)).collect())
}

//! A polygon and its extrusion, as an operator draws it on a display.

use crate::Vec3;
use serde::Deserialize;
use thiserror::Error;

/// All places `q + t e` with q in the polygon and 0 ≤ t ≤ 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Prism {
    origin: Vec3,
    normal: Vec3,
    extrusion: Vec3,
    axes: [Vec3; 2],
    polygon: Vec<[f64; 2]>,
}

/// Why a polygon and an extrusion are no prism.
#[derive(Debug, Error)]
pub enum PrismError {
    /// Not the JSON that is wanted.
    #[error("not a prism (expected {{\"polygon\": [[x,y,z], …], \"extrusion\": [x,y,z]}}, in metres): {0}")]
    Json(#[from] serde_json::Error),
    /// A polygon without area.
    #[error(
        "the polygon of the prism has {0} corners and no area: give at least 3 corners that are not on one line"
    )]
    Flat(usize),
    /// An extrusion inside the plane of the polygon.
    #[error("the extrusion of the prism lies in the plane of its polygon: give another direction")]
    Extrusion,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    polygon: Vec<[f64; 3]>,
    extrusion: [f64; 3],
}

impl Prism {
    /// The prism over `polygon` (corners in order, nearly in one plane) [m] along `extrusion` [m].
    ///
    /// # Errors
    /// A polygon without area, or an extrusion that does not leave its plane.
    pub fn new(polygon: &[Vec3], extrusion: Vec3) -> Result<Prism, PrismError> {
        let flat = PrismError::Flat(polygon.len());
        let Some(&origin) = polygon.first() else { return Err(flat) };
        let next = polygon.iter().cycle().skip(1);
        let sum: Vec3 = polygon.iter().zip(next).map(|(a, b)| (a - origin).cross(&(b - origin))).sum();
        let size = polygon.iter().map(|p| (p - origin).norm_squared()).fold(0.0, f64::max);
        if sum.norm().partial_cmp(&(1e-12 * size)) != Some(std::cmp::Ordering::Greater) {
            return Err(flat);
        }
        let normal = sum.normalize();
        if normal.dot(&extrusion).abs().partial_cmp(&(1e-9 * extrusion.norm()))
            != Some(std::cmp::Ordering::Greater)
        {
            return Err(PrismError::Extrusion);
        }
        let least = normal.iamin();
        let u = normal.cross(&Vec3::ith(least, 1.0)).normalize();
        let axes = [u, normal.cross(&u)];
        let flatten = |p: &Vec3| axes.map(|a| a.dot(&(p - origin)));
        Ok(Prism { origin, normal, extrusion, axes, polygon: polygon.iter().map(flatten).collect() })
    }

    /// Reads `{"polygon": [[x,y,z], …], "extrusion": [x,y,z]}`.
    ///
    /// # Errors
    /// Other JSON, or a polygon and an extrusion that make no prism.
    pub fn from_json(text: &str) -> Result<Prism, PrismError> {
        // Some programs mark UTF-8.
        let file: File = serde_json::from_str(text.strip_prefix('\u{feff}').unwrap_or(text))?;
        let polygon: Vec<Vec3> = file.polygon.into_iter().map(Vec3::from).collect();
        Prism::new(&polygon, file.extrusion.into())
    }

    /// Distance from `p` [m], which is outside, to the surface [m].
    pub(crate) fn distance(&self, p: &Vec3) -> f64 {
        let place = |q: &[f64; 2]| self.origin + self.axes[0] * q[0] + self.axes[1] * q[1];
        let next = self.polygon.iter().cycle().skip(1);
        let sides = self.polygon.iter().zip(next).flat_map(|(a, b)| {
            let [a, b] = [place(a), place(b)];
            let [c, d] = [a + self.extrusion, b + self.extrusion];
            [[a, b, c], [b, d, c]]
        });
        let to_side = |tri| (crate::triangle::closest_point(tri, *p) - p).norm();
        let side = sides.map(to_side).fold(f64::INFINITY, f64::min);
        let from = p - self.origin;
        let ends = [Vec3::zeros(), self.extrusion].map(|shift| {
            let flat = self.axes.map(|a| a.dot(&(from - shift)));
            if self.encloses(flat) { (from - shift).dot(&self.normal).abs() } else { f64::INFINITY }
        });
        side.min(ends[0]).min(ends[1])
    }

    /// The lowest and the highest corner [m].
    pub(crate) fn bounds(&self) -> (Vec3, Vec3) {
        let place = |q: &[f64; 2]| self.origin + self.axes[0] * q[0] + self.axes[1] * q[1];
        let corners = self.polygon.iter().map(place).flat_map(|p| [p, p + self.extrusion]);
        corners.fold((self.origin, self.origin), |(low, high), p| (low.inf(&p), high.sup(&p)))
    }

    /// Whether `p` [m] is inside (even-odd rule for a polygon that crosses itself).
    pub fn contains(&self, p: &Vec3) -> bool {
        let from = p - self.origin;
        let t = from.dot(&self.normal) / self.extrusion.dot(&self.normal);
        if !(0.0..=1.0).contains(&t) {
            return false;
        }
        self.encloses(self.axes.map(|a| a.dot(&(from - self.extrusion * t))))
    }

    /// Whether a place in the plane of the polygon is in the polygon.
    fn encloses(&self, [x, y]: [f64; 2]) -> bool {
        let next = self.polygon.iter().cycle().skip(1);
        let crossed = |(a, b): &(&[f64; 2], &[f64; 2])| {
            (a[1] > y) != (b[1] > y) && x < a[0] + (b[0] - a[0]) * ((y - a[1]) / (b[1] - a[1]))
        };
        self.polygon.iter().zip(next).filter(crossed).count() % 2 == 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slanted_prism_over_a_notched_polygon() {
        let text = r#"{"polygon": [[0,0,1],[2,0,1],[2,2,1],[1,1,1],[0,2,1]], "extrusion": [1,0,2]}"#;
        let prism = Prism::from_json(text).unwrap();
        let has = |x, y, z| prism.contains(&Vec3::new(x, y, z));
        assert!(has(0.5, 0.5, 1.001) && has(1.5, 0.5, 2.9) && !has(0.4, 0.5, 2.9));
        assert!(!has(1.0, 1.5, 1.1) && !has(0.5, 0.5, 0.9) && !has(1.5, 0.5, 3.1));
    }

    #[test]
    fn a_prism_may_begin_with_a_byte_order_mark() {
        let text = r#"{"polygon": [[0,0,0],[1,0,0],[0,1,0]], "extrusion": [0,0,1]}"#;
        let marked = Prism::from_json(&format!("\u{feff}{text}")).unwrap();
        assert!(marked.contains(&Vec3::new(0.2, 0.2, 0.5)));
    }

    #[test]
    fn what_is_no_prism_is_refused() {
        for text in [
            "{}",
            r#"{"polygon": [[0,0,0],[1,0,0]], "extrusion": [0,0,1]}"#,
            r#"{"polygon": [[0,0,0],[1,0,0],[2,0,0]], "extrusion": [0,0,1]}"#,
            r#"{"polygon": [[0,0,0],[1,0,0],[0,1,0]], "extrusion": [1,1,0]}"#,
            r#"{"polygon": [[0,0,0],[1,0,0],[0,1,0]], "extrusion": [0,0,0]}"#,
            r#"{"polygon": [], "extrusion": [0,0,1], "x": 1}"#,
        ] {
            assert!(Prism::from_json(text).is_err(), "{text}");
        }
    }
}

//! Photographs of a stone on a turntable: one camera, one axis, known steps.
//!
//! The axis is z; the camera looks at the origin, which is on the axis, from the distance D at the tilt α above the plane of the table. When the
//! table has turned by θ (anticlockwise, seen from above), the stone sees the camera at the azimuth −θ:
//!
//! ```text
//! eye = D (cos α cos θ, −cos α sin θ, sin α)
//! ```

use crate::camera::Camera;
use geom::Vec3;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// A file that describes a turntable.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Turntable {
    pub camera: TurntableCamera,
    /// Turns of the table.
    pub ring: Vec<Ring>,
}

/// The camera of a turntable.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct TurntableCamera {
    /// Focal length [px].
    pub focal_px: f64,
    /// Where the camera looks, as x and y on the photograph; none: the middle [px].
    #[serde(default)]
    pub centre_px: Option<[f64; 2]>,
    /// From the camera to the point on the axis that it looks at [m].
    pub distance: f64,
    /// k₁, k₂, p₁, p₂ of Brown's distortion [–].
    #[serde(default)]
    pub distortion: [f64; 4],
    /// Width and height of the photographs that the pixels are of; none: those of the masks [px].
    #[serde(default)]
    pub size_px: Option<[f64; 2]>,
}

/// One turn of the table.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Ring {
    /// Names of the photographs, in the order of their names: `*` stands for any characters.
    pub photographs: String,
    /// Height of the camera above the plane of the table, seen from the axis [°].
    pub tilt_deg: f64,
    /// Angle from photograph to photograph; above 0 anticlockwise as seen from above [°].
    pub step_deg: f64,
    /// Angle of the first photograph [°].
    #[serde(default)]
    pub start_deg: f64,
    /// Whether the stone was turned over before this turn, onto another side.
    #[serde(default)]
    pub turned_over: bool,
}

/// What is wrong with a turntable.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TurntableError {
    #[error("{0}")]
    Text(String),
    #[error("{key}: {value}: {what}")]
    Value { key: String, value: f64, what: &'static str },
    #[error("[[ring]] {ring}: no photograph is called {pattern}; there are {examples}")]
    Unmatched { ring: usize, pattern: String, examples: String },
    #[error("[[ring]] {second}: photograph {name} is also in [[ring]] {first}: make the patterns differ")]
    Twice { first: usize, second: usize, name: String },
    #[error(
        "[[ring]] {ring}: {count} photographs of {step}° are {total}°, more than a full turn: check step_deg and the pattern"
    )]
    TooMany { ring: usize, count: usize, step: f64, total: f64 },
}

/// A photograph of a ring.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Number of the photograph in the list of names.
    pub photograph: usize,
    pub ring: usize,
    /// Angle of the table [°].
    pub angle_deg: f64,
}

impl Turntable {
    /// Reads the text (TOML).
    ///
    /// # Errors
    /// Unknown or missing keys, and values that cannot be.
    pub fn parse(text: &str) -> Result<Turntable, TurntableError> {
        let table: Turntable =
            toml::from_str(text).map_err(|e| TurntableError::Text(e.to_string().trim().to_owned()))?;
        let check = |key: &str, value: f64, ok: bool, what: &'static str| {
            if ok && value.is_finite() {
                Ok(())
            } else {
                Err(TurntableError::Value { key: key.to_owned(), value, what })
            }
        };
        let c = &table.camera;
        check("camera.focal_px", c.focal_px, c.focal_px > 0.0, "give the focal length in pixels, above 0")?;
        check("camera.distance", c.distance, c.distance > 0.0, "give the distance in metres, above 0")?;
        for (k, ring) in table.ring.iter().enumerate() {
            let key = |name: &str| format!("[[ring]] {}: {name}", k + 1);
            let (tilt, step) = (ring.tilt_deg, ring.step_deg);
            check(&key("tilt_deg"), tilt, tilt.abs() < 89.0, "give degrees between -89 and 89")?;
            check(
                &key("step_deg"),
                step,
                step != 0.0 && step.abs() <= 120.0,
                "give degrees, not 0, up to 120",
            )?;
            check(&key("start_deg"), ring.start_deg, true, "give degrees")?;
        }
        Ok(table)
    }

    /// Which photographs belong to which ring; names are sorted.
    ///
    /// # Errors
    /// A ring without photographs, one that shares some with another, or with more than a turn of them.
    pub fn places(&self, names: &[String]) -> Result<Vec<Place>, TurntableError> {
        let mut places: Vec<Place> = Vec::new();
        for (ring, r) in self.ring.iter().enumerate() {
            let found: Vec<usize> =
                (0..names.len()).filter(|k| matches(&r.photographs, &names[*k])).collect();
            if found.is_empty() {
                let examples = names.iter().take(3).cloned().collect::<Vec<_>>().join(", ");
                return Err(TurntableError::Unmatched {
                    ring: ring + 1,
                    pattern: r.photographs.clone(),
                    examples,
                });
            }
            let total = found.len() as f64 * r.step_deg.abs();
            if total > 360.0 + 0.5 * r.step_deg.abs() {
                return Err(TurntableError::TooMany {
                    ring: ring + 1,
                    count: found.len(),
                    step: r.step_deg,
                    total,
                });
            }
            for (n, photograph) in found.into_iter().enumerate() {
                if let Some(other) = places.iter().find(|p| p.photograph == photograph) {
                    let name = names[photograph].clone();
                    return Err(TurntableError::Twice { first: other.ring + 1, second: ring + 1, name });
                }
                places.push(Place { photograph, ring, angle_deg: r.start_deg + n as f64 * r.step_deg });
            }
        }
        Ok(places)
    }

    /// The place of a photograph on another turntable: the same number in its ring.
    pub fn place_on(&self, other: &Turntable, place: &Place) -> Place {
        let (from, to) = (&self.ring[place.ring], &other.ring[place.ring]);
        let number = (place.angle_deg - from.start_deg) / from.step_deg;
        Place { angle_deg: to.start_deg + number * to.step_deg, ..*place }
    }

    /// Width and height that the pixels are of, and where the camera looks [px], for photographs of a size.
    pub fn frame(&self, size: [usize; 2]) -> ([f64; 2], [f64; 2]) {
        let [w, h] = self.camera.size_px.unwrap_or(size.map(|s| s as f64));
        ([w, h], self.camera.centre_px.unwrap_or([(w - 1.0) / 2.0, (h - 1.0) / 2.0]))
    }

    /// The camera of a photograph of `width` × `height` pixels, in the frame of the table.
    pub fn camera(&self, place: &Place, width: usize, height: usize) -> Camera {
        let ([w, _], centre) = self.frame([width, height]);
        let (tilt, turn) = (self.ring[place.ring].tilt_deg.to_radians(), place.angle_deg.to_radians());
        let (sin, cos) = (libm::sin, libm::cos);
        let eye = Vec3::new(cos(tilt) * cos(turn), -cos(tilt) * sin(turn), sin(tilt)) * self.camera.distance;
        let camera = Camera::looking(eye, Vec3::zeros(), Vec3::z(), self.camera.focal_px, centre);
        Camera { distortion: self.camera.distortion, ..camera }.resized(width as f64 / w)
    }
}

/// Whether a name fits a pattern in which `*` stands for any characters.
pub fn matches(pattern: &str, name: &str) -> bool {
    let mut parts = pattern.split('*');
    let Some(mut rest) = parts.next().and_then(|first| name.strip_prefix(first)) else { return false };
    let Some(last) = parts.next_back() else { return rest.is_empty() };
    for part in parts {
        match rest.find(part) {
            Some(at) => rest = &rest[at + part.len()..],
            None => return false,
        }
    }
    rest.ends_with(last)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "[camera]\nfocal_px = 700\ndistance = 0.5\n[[ring]]\nphotographs = \"a-*.jpg\"\ntilt_deg = 0\nstep_deg = 90\n\
                        [[ring]]\nphotographs = \"b-*.jpg\"\ntilt_deg = 35\nstep_deg = 90\nturned_over = true\n";

    fn names() -> Vec<String> {
        ["a-1.jpg", "a-2.jpg", "b-1.jpg", "b-2.jpg", "c.jpg"].map(str::to_owned).to_vec()
    }

    #[test]
    fn photographs_find_their_rings() {
        let table = Turntable::parse(TEXT).unwrap();
        let places = table.places(&names()).unwrap();
        assert_eq!(
            places.iter().map(|p| (p.ring, p.angle_deg)).collect::<Vec<_>>(),
            [(0, 0.0), (0, 90.0), (1, 0.0), (1, 90.0)]
        );
        assert!(
            matches("*", "x")
                && matches("a*b*c", "a-b-b-c")
                && !matches("a*b", "ab-")
                && !matches("ab*ba", "aba")
        );
        // The stone has turned by 90°: what was to its right as seen by the camera (+y) is in front.
        let camera = table.camera(&places[1], 320, 240);
        assert!((camera.eye() - Vec3::new(0.0, -0.5, 0.0)).norm() < 1e-12);
        assert!((camera.project(&Vec3::zeros()).0[0] - 159.5).abs() < 1e-9);
    }

    #[test]
    fn wrong_files_are_refused_with_the_key() {
        let says = |text: String, words: &str| {
            let found = Turntable::parse(&text).and_then(|t| t.places(&names())).unwrap_err().to_string();
            assert!(found.contains(words), "{found}");
        };
        says(TEXT.replace("focal_px", "focal"), "focal");
        says(TEXT.replace("700", "-700"), "camera.focal_px: -700");
        says(TEXT.replace("step_deg = 90\nturned", "step_deg = 0\nturned"), "[[ring]] 2: step_deg: 0");
        says(TEXT.replace("a-*", "x-*"), "no photograph is called x-*.jpg");
        says(TEXT.replace("b-*", "a*1*"), "also in [[ring]] 1");
    }
}

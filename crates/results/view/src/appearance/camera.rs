//! The camera: by name, by two angles, or by coordinates.
//!
//! ```text
//! towards the eye = (cos e cos a, cos e sin a, sin e)      a azimuth from x towards y, e elevation above x, y
//! ```

use crate::ViewError;
use geom::Vec3;
use std::str::FromStr;

/// Where to look from; z is up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// From what is looked at towards the eye; unit length.
    pub(crate) towards_eye: Vec3,
    /// The eye [m], when given by coordinates; else the distance is chosen so that everything is seen.
    pub(crate) eye: Option<Vec3>,
    /// The point looked at [m]; without it, the middle of everything.
    pub(crate) target: Option<Vec3>,
}

/// The named directions, from the scene to the eye.
const NAMED: [(&str, [f64; 3]); 16] = [
    ("iso", [0.62, -0.94, 0.62]),
    ("top", [0.0, 0.0, 1.0]),
    ("bottom", [0.0, 0.0, -1.0]),
    ("front", [0.0, -1.0, 0.0]),
    ("back", [0.0, 1.0, 0.0]),
    ("left", [-1.0, 0.0, 0.0]),
    ("right", [1.0, 0.0, 0.0]),
    ("x", [1.0, 0.0, 0.0]),
    ("+x", [1.0, 0.0, 0.0]),
    ("-x", [-1.0, 0.0, 0.0]),
    ("y", [0.0, 1.0, 0.0]),
    ("+y", [0.0, 1.0, 0.0]),
    ("-y", [0.0, -1.0, 0.0]),
    ("z", [0.0, 0.0, 1.0]),
    ("+z", [0.0, 0.0, 1.0]),
    ("-z", [0.0, 0.0, -1.0]),
];

impl Default for Camera {
    fn default() -> Self {
        let towards_eye = Vec3::from(NAMED[0].1).normalize();
        Camera { towards_eye, eye: None, target: None }
    }
}

impl FromStr for Camera {
    type Err = ViewError;

    fn from_str(text: &str) -> Result<Camera, ViewError> {
        let wrong = |problem| ViewError::Camera { text: text.to_owned(), problem };
        if let Some((_, direction)) = NAMED.iter().find(|(name, _)| *name == text) {
            return Ok(Camera { towards_eye: Vec3::from(*direction).normalize(), ..Camera::default() });
        }
        if let Some((azimuth, elevation)) = text.split_once('/') {
            let angle = |part: &str| part.trim().parse().ok().filter(|a: &f64| a.is_finite());
            let (Some(a), Some(e)) = (angle(azimuth), angle(elevation)) else {
                return Err(wrong("an angle is not a number of degrees"));
            };
            if e.abs() > 90.0 {
                return Err(wrong("the elevation is not from -90 to 90 degrees"));
            }
            return Ok(Camera { towards_eye: by_angles(a, e), ..Camera::default() });
        }
        let numbers: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse::<f64>()).collect();
        let numbers = numbers.map_err(|_| wrong("neither a known name nor numbers"))?;
        if numbers.iter().any(|n| !n.is_finite()) {
            return Err(wrong("a coordinate is not finite"));
        }
        let (eye, target) = match numbers[..] {
            [x, y, z] => (Vec3::new(x, y, z), None),
            [x, y, z, tx, ty, tz] => (Vec3::new(x, y, z), Some(Vec3::new(tx, ty, tz))),
            _ => return Err(wrong("3 or 6 numbers are needed")),
        };
        if target == Some(eye) {
            return Err(wrong("the camera is at the point that it looks at"));
        }
        Ok(Camera { eye: Some(eye), target, ..Camera::default() })
    }
}

impl Camera {
    /// Middle of what is seen and direction to the eye, for a scene whose middle is `middle`.
    pub(crate) fn aimed(&self, middle: Vec3) -> (Vec3, Vec3) {
        let target = self.target.unwrap_or(middle);
        match self.eye.map(|eye| eye - target) {
            Some(away) if away.norm() > 0.0 => (target, away.normalize()),
            _ => (target, self.towards_eye),
        }
    }
}

/// The direction of an azimuth and an elevation [°].
fn by_angles(azimuth: f64, elevation: f64) -> Vec3 {
    let [a, e] = [azimuth, elevation].map(f64::to_radians);
    Vec3::new(libm::cos(e) * libm::cos(a), libm::cos(e) * libm::sin(a), libm::sin(e)).normalize()
}

/// Right, up and forward of an eye that looks against `towards_eye`; y is up where z cannot be.
pub(crate) fn axes(towards_eye: Vec3) -> [Vec3; 3] {
    let forward = -towards_eye;
    let pole = if forward.z.abs() > 0.999 { Vec3::y() } else { Vec3::z() };
    let right = forward.cross(&pole).normalize();
    [right, right.cross(&forward), forward]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn from_the_front_x_is_right_and_z_is_up() {
        let camera: Camera = "front".parse().expect("known");
        let [right, up, forward] = axes(camera.aimed(Vec3::zeros()).1);
        assert_eq!([right, up, forward], [Vec3::x(), Vec3::z(), Vec3::y()]);
    }

    #[test]
    fn a_sign_and_two_angles_say_where_the_eye_is() {
        let towards = |text: &str| text.parse::<Camera>().expect("known").aimed(Vec3::zeros()).1;
        assert_eq!([towards("-x"), towards("+z")], [-Vec3::x(), Vec3::z()]);
        assert!((towards("-90/0") - towards("front")).norm() < 1e-15);
        assert!((towards("0/30") - Vec3::new(0.75f64.sqrt(), 0.0, 0.5)).norm() < 1e-15);
    }

    #[test]
    fn an_eye_by_coordinates_looks_at_its_target() {
        let camera: Camera = "0, 0, 3, 0, 0, 1".parse().expect("numbers");
        assert_eq!(camera.aimed(Vec3::x()), (Vec3::z(), Vec3::z()));
    }

    #[test]
    fn nonsense_is_refused_with_what_is_known() {
        for text in ["", "above", "1,2", "1,2,nan", "1,1,1,1,1,1", "30/91", "a/2", "inf/0"] {
            let message = text.parse::<Camera>().expect_err("nonsense").to_string();
            assert!(message.contains("iso") && message.contains(text), "{message}");
        }
    }
}

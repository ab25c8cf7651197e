//! The eye: from metres to samples of the picture.

use super::{PictureOptions, paint::Painted};
use crate::camera;
use geom::Vec3;

/// Samples along each side of a pixel.
pub const SAMPLES: usize = 2;

/// Half the height of the view, as the tangent of its angle.
const HALF_VIEW: f64 = 0.2679;

/// Share of the width kept free at the right for the colour bar.
const BAR_SHARE: f64 = 0.09;

/// A pinhole eye. Seen coordinates: x right, y up, z forward from the eye [m].
pub(crate) struct Lens {
    eye: Vec3,
    axes: [Vec3; 3],
    /// Samples per unit of x/z.
    pub focal: f64,
    /// Where the axis of the eye meets the picture [sample].
    pub centre: [f64; 2],
    /// Size of the picture [sample].
    pub size: [usize; 2],
    /// Distance of the point looked at [m].
    pub distance: f64,
}

impl Lens {
    /// The lens that sees all of `painted`, or from where the camera says.
    pub fn new(painted: &Painted, options: &PictureOptions) -> Lens {
        let size = [options.width as usize * SAMPLES, options.height as usize * SAMPLES];
        let [w, h] = size.map(|s| s as f64);
        let (target, towards_eye) = options.camera.aimed(painted.middle());
        let axes = camera::axes(towards_eye);
        let focal = 0.5 * h / HALF_VIEW;
        let free = [w * (1.0 - BAR_SHARE), h];
        let centre = [0.5 * free[0], 0.49 * h];
        let distance = match options.camera.eye {
            Some(eye) => (eye - target).norm(),
            None => fitted(painted, target, &axes, free.map(|s| 0.46 * s / focal)),
        };
        Lens { eye: target + towards_eye * distance, axes, focal, centre, size, distance }
    }

    /// The point as seen from the eye.
    pub fn seen(&self, point: Vec3) -> [f64; 3] {
        let away = point - self.eye;
        self.axes.map(|axis| axis.dot(&away))
    }

    /// Pixels per metre at the point looked at.
    pub fn pixels_per_metre(&self) -> f64 {
        self.focal / self.distance / SAMPLES as f64
    }

    /// The direction of an axis of the world (0 x, 1 y, 2 z) on the picture: right, down, and away.
    pub fn axis(&self, k: usize) -> [f64; 3] {
        [self.axes[0][k], -self.axes[1][k], self.axes[2][k]]
    }
}

/// The least distance [m] from which every corner of the box lies within `half` = x/z, y/z.
fn fitted(painted: &Painted, target: Vec3, axes: &[Vec3; 3], half: [f64; 2]) -> f64 {
    let corner = |n: usize| {
        let side = |k: usize| if n >> k & 1 == 0 { painted.extent[k].lo } else { painted.extent[k].hi };
        Vec3::new(side(0), side(1), side(2)) - target
    };
    let needed = |n: usize| {
        let [x, y, z] = axes.map(|axis| axis.dot(&corner(n)));
        (x.abs() / half[0]).max(y.abs() / half[1]) - z
    };
    (0..8).map(needed).fold(1e-9, f64::max)
}

/// The samples that a sphere at `c` (coordinate and depth) with radius `r` covers along one side: its two tangents.
pub fn tangents(c: f64, z: f64, r: f64) -> Option<[f64; 2]> {
    let gap = z * z - r * r;
    if z <= 0.0 || gap <= 0.02 * z * z {
        return None; // the eye is in the sphere, or nearly
    }
    let root = r * (c * c + gap).sqrt();
    Some([(c * z - root) / gap, (c * z + root) / gap])
}

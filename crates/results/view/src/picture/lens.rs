//! The projection: from metres to samples of the picture.

use super::{
    caption::{boxes, text_height},
    hull::meets,
    options::PictureOptions,
    paint::Painted,
};
use crate::appearance::{camera, scale::Range};
use crate::{GrainCount, Role};
use geom::Vec3;

/// Samples along each side of a pixel.
pub const SAMPLES: usize = 2;

/// Half the height of the view, as the tangent of its angle.
const HALF_VIEW: f64 = 0.2679;

/// Share of the width kept free at the right for the colour bar, and that in heights of capitals: the larger of the two.
const BAR_SHARE: f64 = 0.09;
const BAR_TEXT: f64 = 8.5;

/// Distance of a far lens, in radii of what it sees [–].
const FAR: f64 = 50.0;

/// A part of the picture: its middle, and half of what may be filled each way [sample].
#[derive(Clone, Copy)]
struct Area {
    centre: [f64; 2],
    half: [f64; 2],
}

impl Area {
    /// Of left, top, right, bottom, with a margin.
    fn within([left, top, right, bottom]: [f64; 4]) -> Area {
        let half = |from: f64, to: f64| 0.47 * (to - from).max(1.0);
        Area {
            centre: [0.5 * (left + right), 0.5 * (top + bottom)],
            half: [half(left, right), half(top, bottom)],
        }
    }
}

/// A pinhole eye. Seen coordinates: x right, y up, z forward from the eye [m].
pub(crate) struct Lens {
    /// Where it is [m].
    pub eye: Vec3,
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
        let bar = BAR_TEXT * text_height(options.width, options.height) * SAMPLES as f64;
        let free = [w - bar.max(BAR_SHARE * w), h];
        let whole = Area { centre: [0.5 * free[0], 0.49 * h], half: free.map(|s| 0.46 * s) };
        let lens = |area: Area, (target, distance): (Vec3, f64)| {
            let eye = target + towards_eye * distance;
            Lens { eye, axes, focal, centre: area.centre, size, distance }
        };
        if let Some(eye) = options.camera.eye {
            return lens(whole, (target, (eye - target).norm()));
        }
        let fit = |area: Area| fitted(&painted.outline, target, &axes, area.half.map(|s| s / focal));
        let first = lens(whole, fit(whole));
        let text = boxes(painted, options).map(|side| side.map(|v| v * SAMPLES as f64));
        if !text.iter().any(|side| first.covers(&painted.outline, *side)) {
            return first;
        }
        // What would be under the text goes between it, or beside it, whichever leaves it larger.
        let [head, foot] = text;
        let ways = [[0.0, head[3], free[0], foot[1]], [head[2].max(foot[2]), 0.0, free[0], h]];
        let ways = ways.map(Area::within).map(|area| (area, fit(area)));
        let [between, beside] = ways;
        let (area, seen) = if beside.1.1 < between.1.1 { beside } else { between };
        lens(area, seen)
    }

    /// Longer side of the box around places, as seen and inside the picture [pixel].
    pub fn longer_side(&self, places: &[Vec3]) -> u32 {
        let seen = places.iter().map(|p| self.seen(*p)).filter(|p| p[2] > 0.0);
        let on = |p: [f64; 3]| [0, 1].map(|k| (p[k] / p[2] * self.focal, self.size[k] as f64));
        let mut sides = [Range::EMPTY; 2];
        for point in seen.map(on) {
            for (side, (at, size)) in sides.iter_mut().zip(point) {
                *side = side.with(Range::of([at.clamp(-size, size)]));
            }
        }
        let longer = sides.map(|side| (side.hi - side.lo).max(0.0)).into_iter().fold(0.0, f64::max);
        (longer / SAMPLES as f64).ceil() as u32
    }

    /// Whether the outline of places, as seen, reaches into a part of the picture: left, top, right, bottom [sample].
    fn covers(&self, places: &[Vec3], part: [f64; 4]) -> bool {
        let seen = places.iter().map(|p| self.seen(*p)).filter(|p| p[2] > 0.0);
        let on = |p: [f64; 3]| {
            [self.centre[0] + self.focal * p[0] / p[2], self.centre[1] - self.focal * p[1] / p[2]]
        };
        meets(seen.map(on).collect(), part)
    }

    /// A lens so far off that it sees a ball of `radius` [m] around `middle` nearly without perspective, on
    /// `size` x `size` samples.
    pub fn far(middle: Vec3, radius: f64, towards_eye: Vec3, size: usize) -> Lens {
        let radius = radius.max(1e-9);
        let distance = FAR * radius;
        Lens {
            eye: middle + towards_eye * distance,
            axes: camera::axes(towards_eye),
            focal: 0.5 * size as f64 * (FAR - 1.0),
            centre: [0.5 * size as f64; 2],
            size: [size; 2],
            distance,
        }
    }

    /// The place of a point as seen.
    pub fn place(&self, seen: [f64; 3]) -> Vec3 {
        self.eye + self.axes[0] * seen[0] + self.axes[1] * seen[1] + self.axes[2] * seen[2]
    }

    /// What a sample sees at a depth [m].
    pub fn at(&self, sample: [usize; 2], depth: f64) -> [f64; 3] {
        let dx = (sample[0] as f64 + 0.5 - self.centre[0]) / self.focal;
        let dy = (self.centre[1] - sample[1] as f64 - 0.5) / self.focal;
        [dx * depth, dy * depth, depth]
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

    /// What a sphere covers: first and last sample in x and y, not cut to the picture; none where the eye is in it, or
    /// it is behind the eye.
    pub fn window(&self, [x, y, z]: [f64; 3], radius: f64) -> Option<[f64; 4]> {
        let [x0, x1] = tangents(x, z, radius)?;
        let [y0, y1] = tangents(y, z, radius)?;
        let [cx, cy] = self.centre;
        Some([cx + self.focal * x0, cx + self.focal * x1, cy - self.focal * y1, cy - self.focal * y0])
    }

    /// Whether a window reaches into the picture.
    pub fn shows(&self, window: [f64; 4]) -> bool {
        window[1] >= 0.0
            && window[3] >= 0.0
            && window[0] < self.size[0] as f64
            && window[2] < self.size[1] as f64
    }

    /// Whether any of a sphere [m] is in the picture.
    pub fn reaches(&self, centre: Vec3, radius: f64) -> bool {
        self.window(self.seen(centre), radius).is_some_and(|window| self.shows(window))
    }

    /// Grains that are not in the picture at all, unless the place of the eye was given, and all grains.
    pub fn outside(&self, painted: &Painted, options: &PictureOptions) -> [usize; 2] {
        let mut found = [0; 2];
        for layer in painted.layers.iter().filter(|l| l.role == Role::Grains) {
            let count = GrainCount::with(layer.spheres.len(), &layer.bodies);
            let missed = |row: usize| !self.reaches(layer.spheres.at(row), layer.spheres.radius(row));
            let mut alone: Vec<bool> = (0..layer.spheres.len()).map(missed).collect();
            for rows in &layer.bodies {
                let all = rows.iter().all(|&row| alone[row as usize]);
                rows.iter().for_each(|&row| alone[row as usize] = false);
                alone[rows[0] as usize] = all;
            }
            let missed = alone.iter().filter(|missed| **missed).count();
            found = [found[0] + missed, found[1] + count.grains()];
        }
        if options.camera.eye.is_some() { [0, found[1]] } else { found }
    }

    /// The direction of an axis of the world (0 x, 1 y, 2 z) on the picture: right, down, and away.
    pub fn axis(&self, k: usize) -> [f64; 3] {
        [self.axes[0][k], -self.axes[1][k], self.axes[2][k]]
    }
}

/// The point to look at and the least distance [m] from which all `places` lie within `half` = x/z, y/z.
///
/// ```text
/// |x − tₓ| ≤ hₓ (z + d)  for all places   ⇔   A − hₓ d ≤ tₓ ≤ B + hₓ d,   A = max(x − hₓ z), B = min(x + hₓ z)
/// ```
///
/// so d = (A − B)/2hₓ and tₓ = (A + B)/2, and the same with y; x, y, z are seen from `near`, any point.
fn fitted(places: &[Vec3], near: Vec3, axes: &[Vec3; 3], half: [f64; 2]) -> (Vec3, f64) {
    let seen: Vec<[f64; 3]> = places.iter().map(|p| axes.map(|a| a.dot(&(p - near)))).collect();
    let ends = |of: &dyn Fn(&[f64; 3]) -> f64| Range::of(seen.iter().map(of));
    let depth = ends(&|p| p[2]);
    let far = [0, 1].map(|k| ends(&|p| p[k] - half[k] * p[2]).hi);
    let low = [0, 1].map(|k| ends(&|p| p[k] + half[k] * p[2]).lo);
    let needed = |k: usize| (far[k] - low[k]) / (2.0 * half[k]);
    let back = needed(0).max(needed(1));
    let middle = 0.5 * (depth.lo + depth.hi);
    let [x, y] = [0, 1].map(|k| 0.5 * (far[k] + low[k]));
    (near + axes[0] * x + axes[1] * y + axes[2] * middle, (back + middle).max(1e-9))
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

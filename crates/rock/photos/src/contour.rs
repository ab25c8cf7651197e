//! The edge of a mask: the line on which coverage is one half, between the centres of pixels (marching squares).

use crate::mask::Mask;

/// A piece of the edge, within four pixels; the stone is on its left as seen with y down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// Start: x, y [px].
    pub from: [f32; 2],
    /// End: x, y [px].
    pub to: [f32; 2],
}

/// Coverage that is the edge [0–255].
pub(crate) const HALF: f32 = 127.5;

impl Segment {
    /// Distance of a point [px].
    pub fn distance(&self, p: [f32; 2]) -> f32 {
        let [ax, ay] = self.from;
        let (ux, uy) = (self.to[0] - ax, self.to[1] - ay);
        let (px, py) = (p[0] - ax, p[1] - ay);
        let square = ux * ux + uy * uy;
        let t = if square > 0.0 { ((px * ux + py * uy) / square).clamp(0.0, 1.0) } else { 0.0 };
        let (dx, dy) = (px - t * ux, py - t * uy);
        (dx * dx + dy * dy).sqrt()
    }

    /// The point half way [px].
    pub fn middle(&self) -> [f32; 2] {
        [0, 1].map(|k| (self.from[k] + self.to[k]) / 2.0)
    }
}

/// The edge of a mask. Where the mask is cut by the frame, the frame is no edge.
pub fn contour(mask: &Mask) -> Vec<Segment> {
    of_values(mask.width, mask.height, |k| f32::from(mask.coverage[k]))
}

pub(crate) fn of_values(width: usize, height: usize, value: impl Fn(usize) -> f32) -> Vec<Segment> {
    let mut segments = Vec::new();
    for y in 0..height.saturating_sub(1) {
        for x in 0..width.saturating_sub(1) {
            let k = y * width + x;
            // Around the cell: top left, top right, bottom right, bottom left.
            let corners = [k, k + 1, k + width + 1, k + width].map(|k| value(k) - HALF);
            cell([x as f32, y as f32], corners, &mut segments);
        }
    }
    segments
}

/// Segments of a cell of four pixels.
fn cell([x, y]: [f32; 2], v: [f32; 4], out: &mut Vec<Segment>) {
    let inside = v.map(|v| v > 0.0);
    if inside.iter().all(|i| *i == inside[0]) {
        return;
    }
    let places = [[x, y], [x + 1.0, y], [x + 1.0, y + 1.0], [x, y + 1.0]];
    let cut = |i: usize| {
        let j = (i + 1) % 4;
        let t = v[i] / (v[i] - v[j]);
        [0, 1].map(|a| places[i][a] + t * (places[j][a] - places[i][a]))
    };
    // Sides on which the way around leaves the stone, and those on which it enters.
    let leaves: Vec<usize> = (0..4).filter(|i| inside[*i] && !inside[(i + 1) % 4]).collect();
    let enters: Vec<usize> = (0..4).filter(|i| !inside[*i] && inside[(i + 1) % 4]).collect();
    let joined = v.iter().sum::<f32>() > 0.0;
    for (n, side) in leaves.iter().enumerate() {
        // Two regions of the stone at opposite corners: joined when the mean is inside.
        let other = match enters.len() {
            1 => enters[0],
            _ if joined => *enters.iter().find(|e| **e == (side + 1) % 4).unwrap_or(&enters[n]),
            _ => *enters.iter().find(|e| **e == (side + 3) % 4).unwrap_or(&enters[n]),
        };
        out.push(Segment { from: cut(*side), to: cut(other) });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A disc drawn by coverage has its edge at its radius to a tenth of a pixel, and its length.
    #[test]
    fn the_edge_of_a_disc_is_at_its_radius() {
        let (c, r) = ([20.3f32, 19.6], 12.4f32);
        let value = |k: usize| {
            let d = r - ((k % 41) as f32 - c[0]).hypot((k / 41) as f32 - c[1]);
            (255.0 * (d + 0.5)).clamp(0.0, 255.0)
        };
        let edge = of_values(41, 41, value);
        for s in &edge {
            let off = (s.from[0] - c[0]).hypot(s.from[1] - c[1]) - r;
            assert!(off.abs() < 0.1, "{off}");
        }
        let length: f32 = edge.iter().map(|s| (s.to[0] - s.from[0]).hypot(s.to[1] - s.from[1])).sum();
        assert!((length / (std::f32::consts::TAU * r) - 1.0).abs() < 0.01, "{length}");
        // A closed line: every end is a start.
        assert!(
            edge.iter().all(|s| edge.iter().any(|t| (t.from[0] - s.to[0]).hypot(t.from[1] - s.to[1]) < 1e-4))
        );
    }

    #[test]
    fn opposite_corners_give_two_segments() {
        let edge = of_values(2, 2, |k| if k == 0 || k == 3 { 255.0 } else { 0.0 });
        assert_eq!(edge.len(), 2);
        assert!(
            (edge[0].distance([0.0, 0.0]) - 0.5f32.sqrt() / 2.0).abs() < 1e-6
                || edge[0].distance([1.0, 1.0]) > 0.0
        );
    }
}

//! The z-buffer: the nearest sphere or rod at each sample of the picture, and its distance.
//!
//! The picture is cut into tiles; a tile draws its spheres from near to far, in the order of their numbers where
//! equally near, and skips those behind all it has drawn. Tiles do not touch each other's samples, so the result
//! does not depend on the number of threads. What a sphere looks like is computed where it is needed, and not kept.

use super::{
    joined::Joined,
    lens::Lens,
    rods::{Rod, SeenRod},
};
use rayon::prelude::*;

/// Side of a tile [sample].
const TILE: usize = 64;

/// No sphere here.
pub const NOTHING: u32 = u32::MAX;

/// Spheres that are given to tiles together.
const CHUNK: usize = 1 << 14;

/// A sphere as seen from the eye.
struct Ball {
    /// Centre: right, up, forward [m].
    centre: [f64; 3],
    /// Radius [m].
    radius: f64,
    /// First and last sample in x and y, not yet cut to the picture.
    window: [f64; 4],
}

/// The nearest surface at each sample.
pub struct Depths {
    /// Distance along the axis of the eye [m]; infinite where there is nothing; empty without spheres and rods.
    pub depth: Vec<f32>,
    /// The number of the sphere there, or, beyond all spheres, the rod; or [`NOTHING`].
    ball: Vec<u32>,
    /// How many spheres were given.
    spheres: usize,
    /// The rods that are seen, each with its number in the list it came from.
    rods: Vec<(SeenRod, u32)>,
}

/// What is met at a sample.
pub struct Met {
    /// Unit normal [–].
    pub normal: [f32; 3],
    /// Radius [m].
    pub radius: f64,
    /// Number in the list of spheres, or after these, in that of rods.
    pub number: usize,
    /// The body that it is a part of, see [`super::kin`].
    pub body: Option<u32>,
}

impl Depths {
    /// Distance of what is at a sample [m]; infinite where there is nothing.
    pub fn depth(&self, sample: usize) -> f32 {
        self.depth.get(sample).copied().unwrap_or(f32::INFINITY)
    }

    /// What is at a sample, or [`NOTHING`]: a number that samples of the same sphere or rod share.
    pub fn ball(&self, sample: usize) -> u32 {
        self.ball.get(sample).copied().unwrap_or(NOTHING)
    }

    /// What is at a sample that sees `point`.
    pub fn met(&self, sample: usize, point: [f64; 3], spheres: &Joined, lens: &Lens) -> Option<Met> {
        let number = self.number(sample)?;
        if number < self.spheres {
            let (centre, radius) = (lens.seen(spheres.at(number)), spheres.radius(number));
            let normal = std::array::from_fn(|k| ((point[k] - centre[k]) / radius) as f32);
            return Some(Met { normal, radius, number, body: None });
        }
        let (rod, _) = self.rods.get(self.ball(sample) as usize - self.spheres)?;
        Some(Met { normal: rod.normal(point), radius: rod.radius(), number, body: None })
    }

    /// The number of what is at a sample, as in [`Met`].
    pub fn number(&self, sample: usize) -> Option<usize> {
        let found = self.ball(sample);
        match (found as usize).checked_sub(self.spheres) {
            None => Some(found as usize),
            Some(_) if found == NOTHING => None,
            Some(rod) => self.rods.get(rod).map(|(_, number)| self.spheres + *number as usize),
        }
    }
}

/// Draws all spheres and rods.
pub fn splat(spheres: &Joined, rods: &[Rod], lens: &Lens) -> Depths {
    let [w, h] = lens.size;
    let across = w.div_ceil(TILE);
    let seen = |(number, rod): (usize, &Rod)| Some((SeenRod::new(rod, lens)?, number as u32));
    let rods: Vec<(SeenRod, u32)> = rods.iter().enumerate().filter_map(seen).collect();
    let samples = if spheres.len() == 0 && rods.is_empty() { 0 } else { w * h };
    let lists = by_tile(spheres.len(), |i| Ball::seen(spheres, i, lens).map(|ball| ball.window), [w, h]);
    let rod_lists = by_tile(rods.len(), |i| Some(rods[i].0.window), [w, h]);
    let mut depth = vec![f32::INFINITY; samples];
    let mut ball = vec![NOTHING; samples];
    let bands = depth.par_chunks_mut(TILE * w).zip(ball.par_chunks_mut(TILE * w));
    bands.enumerate().for_each(|(row, (depth, ball))| {
        for column in 0..across {
            let mut tile = Tile { depth, ball, width: w, left: column * TILE, top: row * TILE };
            tile.draw(spheres, &lists[row * across + column], lens);
            for &number in &rod_lists[row * across + column] {
                tile.draw_rod(&rods[number as usize].0, spheres.len() as u32 + number, lens);
            }
        }
    });
    Depths { depth, ball, spheres: spheres.len(), rods }
}

impl Ball {
    /// None where nothing of it is in the picture, or the eye is in it.
    fn seen(spheres: &Joined, i: usize, lens: &Lens) -> Option<Ball> {
        let (centre, radius) = (lens.seen(spheres.at(i)), spheres.radius(i));
        let window = lens.window(centre, radius)?;
        lens.shows(window).then_some(Ball { centre, radius, window })
    }
}

/// The numbers of `count` things whose windows reach into each tile, in their order.
fn by_tile(
    count: usize,
    window: impl Fn(usize) -> Option<[f64; 4]> + Sync,
    size: [usize; 2],
) -> Vec<Vec<u32>> {
    let [across, down] = size.map(|s| s.div_ceil(TILE));
    let tile = |sample: f64, count: usize| (sample.max(0.0) as usize / TILE).min(count - 1);
    let chunk = |first: usize| {
        let mut found = Vec::new();
        for number in first..(first + CHUNK).min(count) {
            let Some([x0, x1, y0, y1]) = window(number) else { continue };
            for row in tile(y0, down)..=tile(y1, down) {
                let columns = tile(x0, across)..=tile(x1, across);
                found.extend(columns.map(|column| [(row * across + column) as u32, number as u32]));
            }
        }
        found
    };
    let found: Vec<Vec<[u32; 2]>> =
        (0..count.div_ceil(CHUNK)).into_par_iter().map(|n| chunk(n * CHUNK)).collect();
    let mut counts = vec![0; across * down];
    found.iter().flatten().for_each(|[tile, _]| counts[*tile as usize] += 1);
    let mut lists: Vec<Vec<u32>> = counts.into_iter().map(Vec::with_capacity).collect();
    found.iter().flatten().for_each(|[tile, number]| lists[*tile as usize].push(*number));
    lists
}

/// One tile, in the band of rows that holds it.
struct Tile<'a> {
    depth: &'a mut [f32],
    ball: &'a mut [u32],
    width: usize,
    left: usize,
    top: usize,
}

impl Tile<'_> {
    fn draw(&mut self, spheres: &Joined, list: &[u32], lens: &Lens) {
        let near = |&i: &u32| (lens.seen(spheres.at(i as usize))[2] - spheres.radius(i as usize), i);
        let mut list: Vec<(f64, u32)> = list.iter().map(near).collect();
        list.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut behind = f32::INFINITY;
        for (n, &(near, number)) in list.iter().enumerate() {
            if n % 64 == 63 {
                behind = self.farthest();
            }
            if near as f32 > behind {
                return; // all others are farther still
            }
            if let Some(ball) = Ball::seen(spheres, number as usize, lens) {
                self.draw_ball(&ball, number, lens);
            }
        }
    }

    /// Samples of the tile, as ends of its columns and rows in the band.
    fn bounds(&self) -> [usize; 4] {
        let rows = self.depth.len() / self.width;
        [self.left, (self.left + TILE).min(self.width), 0, rows]
    }

    fn farthest(&self) -> f32 {
        let [x0, x1, y0, y1] = self.bounds();
        let row = |y: usize| &self.depth[y * self.width + x0..y * self.width + x1];
        (y0..y1).flat_map(row).copied().fold(0.0, f32::max)
    }

    /// Columns and rows of the tile that a window covers.
    fn part(&self, [bx0, bx1, by0, by1]: [f64; 4]) -> [usize; 4] {
        let [x0, x1, y0, y1] = self.bounds();
        let from = |sample: f64, low: usize| (sample.ceil().max(0.0) as usize).max(low);
        let to = |sample: f64, high: usize| ((sample.floor().max(-1.0) + 1.0) as usize).min(high);
        let [left, right] = [from(bx0 - 0.5, x0), to(bx1 - 0.5, x1)];
        [left, right, from(by0 - 0.5, self.top + y0), to(by1 - 0.5, self.top + y1)]
    }

    fn draw_rod(&mut self, rod: &SeenRod, number: u32, lens: &Lens) {
        let [left, right, top, bottom] = self.part(rod.window);
        for y in top..bottom {
            let dy = (lens.centre[1] - (y as f64 + 0.5)) / lens.focal;
            let base = (y - self.top) * self.width;
            for x in left..right {
                let dx = (x as f64 + 0.5 - lens.centre[0]) / lens.focal;
                let Some(depth) = rod.depth(dx, dy) else { continue };
                if (depth as f32) < self.depth[base + x] {
                    self.depth[base + x] = depth as f32;
                    self.ball[base + x] = number;
                }
            }
        }
    }

    fn draw_ball(&mut self, ball: &Ball, number: u32, lens: &Lens) {
        let [left, right, top, bottom] = self.part(ball.window);
        let [cx, cy, cz] = ball.centre;
        let outside = cx * cx + cy * cy + cz * cz - ball.radius * ball.radius;
        for y in top..bottom {
            let dy = (lens.centre[1] - (y as f64 + 0.5)) / lens.focal;
            let base = (y - self.top) * self.width;
            for x in left..right {
                let dx = (x as f64 + 0.5 - lens.centre[0]) / lens.focal;
                let (a, b) = (dx * dx + dy * dy + 1.0, dx * cx + dy * cy + cz);
                let inside = b * b - a * outside;
                if inside < 0.0 {
                    continue;
                }
                let depth = ((b - inside.sqrt()) / a) as f32;
                if depth < self.depth[base + x] {
                    self.depth[base + x] = depth;
                    self.ball[base + x] = number;
                }
            }
        }
    }
}

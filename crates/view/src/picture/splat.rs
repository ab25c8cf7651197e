//! The z-buffer: the nearest sphere or rod at each sample of the picture, and its distance.
//!
//! The picture is cut into tiles; a tile draws its spheres from near to far, in the order of their numbers where
//! equally near, and skips those behind all it has drawn. Tiles do not touch each other's samples, so the result
//! does not depend on the number of threads.

use super::{
    lens::Lens,
    rods::{Rod, SeenRod},
};
use crate::spheres::Spheres;
use rayon::prelude::*;

/// Side of a tile [sample].
const TILE: usize = 64;

/// No sphere here.
pub const NOTHING: u32 = u32::MAX;

/// A sphere as seen from the eye.
#[derive(Clone, Copy)]
pub struct Ball {
    /// Centre: right, up, forward [m].
    pub centre: [f64; 3],
    /// Radius [m].
    pub radius: f64,
    /// First and last sample in x and y, not yet cut to the picture.
    window: [f64; 4],
    /// Number in the list it came from.
    pub number: u32,
}

/// The nearest surface at each sample.
pub struct Depths {
    /// Distance along the axis of the eye [m]; infinite where there is nothing.
    pub depth: Vec<f32>,
    /// The ball there, or, beyond all balls, the rod; or [`NOTHING`].
    pub ball: Vec<u32>,
    /// The balls.
    pub balls: Vec<Ball>,
    /// The rods, each with its number in the list it came from.
    pub rods: Vec<(SeenRod, u32)>,
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
    /// What is at a sample that sees `point`; `spheres` is how many spheres were given.
    pub fn met(&self, sample: usize, point: [f64; 3], spheres: usize) -> Option<Met> {
        let found = self.ball[sample];
        if found == NOTHING {
            return None;
        }
        let found = found as usize;
        if let Some(ball) = self.balls.get(found) {
            let normal = std::array::from_fn(|k| ((point[k] - ball.centre[k]) / ball.radius) as f32);
            return Some(Met { normal, radius: ball.radius, number: ball.number as usize, body: None });
        }
        let (rod, number) = self.rods.get(found - self.balls.len())?;
        let (normal, radius) = (rod.normal(point), rod.radius());
        Some(Met { normal, radius, number: spheres + *number as usize, body: None })
    }

    /// Keeps the balls that are seen at some sample only: of a cloud of millions most are behind others.
    fn forget_hidden(&mut self) {
        let all = self.balls.len() as u32;
        let mut places = vec![NOTHING; self.balls.len()];
        self.ball.iter().filter(|found| **found < all).for_each(|&found| places[found as usize] = 0);
        let mut kept = 0;
        for place in places.iter_mut().filter(|place| **place == 0) {
            *place = kept;
            kept += 1;
        }
        let mut seen = places.iter().map(|place| *place != NOTHING);
        self.balls.retain(|_| seen.next().unwrap_or(false));
        self.balls.shrink_to_fit();
        for found in self.ball.iter_mut().filter(|found| **found != NOTHING) {
            *found = if *found < all { places[*found as usize] } else { *found - all + kept };
        }
    }

    /// The number of what is at a sample, as in [`Met`].
    pub fn number(&self, sample: usize, spheres: usize) -> Option<usize> {
        let found = self.ball[sample] as usize;
        let rod = || self.rods.get(found - self.balls.len()).map(|(_, number)| spheres + *number as usize);
        match self.balls.get(found) {
            Some(ball) => Some(ball.number as usize),
            None if self.ball[sample] == NOTHING => None,
            None => rod(),
        }
    }
}

/// Draws all spheres and rods.
pub fn splat(spheres: &Spheres, rods: &[Rod], lens: &Lens) -> Depths {
    let ball = |i: usize| seen_ball(spheres, i, lens);
    let mut balls: Vec<Ball> = (0..spheres.len()).into_par_iter().filter_map(ball).collect();
    let near = |b: &Ball| b.centre[2] - b.radius;
    balls.par_sort_unstable_by(|a, b| near(a).total_cmp(&near(b)).then(a.number.cmp(&b.number)));
    let [w, h] = lens.size;
    let across = w.div_ceil(TILE);
    let lists = by_tile(balls.iter().map(|b| b.window), [w, h]);
    let seen = |(number, rod): (usize, &Rod)| Some((SeenRod::new(rod, lens)?, number as u32));
    let rods: Vec<(SeenRod, u32)> = rods.iter().enumerate().filter_map(seen).collect();
    let mut depths = Depths { depth: vec![f32::INFINITY; w * h], ball: vec![NOTHING; w * h], balls, rods };
    let bands = depths.depth.par_chunks_mut(TILE * w).zip(depths.ball.par_chunks_mut(TILE * w));
    let rod_lists = by_tile(depths.rods.iter().map(|(rod, _)| rod.window), [w, h]);
    let (balls, rods) = (&depths.balls, &depths.rods);
    bands.enumerate().for_each(|(row, (depth, ball))| {
        for column in 0..across {
            let mut tile = Tile { depth, ball, width: w, left: column * TILE, top: row * TILE };
            tile.draw(balls, &lists[row * across + column], lens);
            for &number in &rod_lists[row * across + column] {
                tile.draw_rod(&rods[number as usize].0, balls.len() as u32 + number, lens);
            }
        }
    });
    depths.forget_hidden();
    depths
}

fn seen_ball(spheres: &Spheres, i: usize, lens: &Lens) -> Option<Ball> {
    let centre = lens.seen(spheres.at(i));
    let radius = spheres.radius[i];
    let window = lens.window(centre, radius)?;
    lens.shows(window).then_some(Ball { centre, radius, window, number: i as u32 })
}

/// The numbers of the windows that reach into each tile, in their order.
fn by_tile(windows: impl Iterator<Item = [f64; 4]>, size: [usize; 2]) -> Vec<Vec<u32>> {
    let [across, down] = size.map(|s| s.div_ceil(TILE));
    let mut lists = vec![Vec::new(); across * down];
    let tile = |sample: f64, count: usize| (sample.max(0.0) as usize / TILE).min(count - 1);
    for (number, [x0, x1, y0, y1]) in windows.enumerate() {
        for row in tile(y0, down)..=tile(y1, down) {
            for column in tile(x0, across)..=tile(x1, across) {
                lists[row * across + column].push(number as u32);
            }
        }
    }
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
    fn draw(&mut self, balls: &[Ball], list: &[u32], lens: &Lens) {
        let mut behind = f32::INFINITY;
        for (n, &number) in list.iter().enumerate() {
            let ball = &balls[number as usize];
            if n % 64 == 63 {
                behind = self.farthest();
            }
            if (ball.centre[2] - ball.radius) as f32 > behind {
                return; // all others are farther still
            }
            self.draw_ball(ball, number, lens);
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

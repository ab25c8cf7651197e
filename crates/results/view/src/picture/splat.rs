//! The z-buffer: the nearest sphere or rod at each sample of the picture, and its distance.
//!
//! The picture is cut into tiles; a tile draws its spheres from near to far, in the order of their numbers where
//! equally near, and skips those behind all it has drawn. Tiles do not touch each other's samples, so the result
//! does not depend on the number of threads. What a sphere looks like is computed where it is needed, and not kept.
//!
//! A picture is made from the top down, and only the rows of tiles that are looked at are held: what a large picture
//! needs does not grow with its height.

use super::{joined::Joined, lens::Lens, rod::Rod, rods::SeenRod};
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

/// The nearest surface at each sample of the rows that are held.
pub struct Depths {
    /// Distance along the axis of the eye [m]; infinite where there is nothing; empty without spheres and rods.
    depth: Vec<f32>,
    /// The number of the sphere there, or, beyond all spheres, the rod; or [`NOTHING`].
    ball: Vec<u32>,
    /// The first sample that is held.
    first: usize,
    /// Rows of tiles that are drawn, some of them no longer held.
    drawn: usize,
    /// What is in each tile that is not drawn: numbers of spheres, and of rods.
    lists: [Vec<Vec<u32>>; 2],
    /// How many spheres were given.
    spheres: usize,
    /// The rods that are seen, each with its number in the list it came from.
    rods: Vec<(SeenRod, u32)>,
    /// Nothing is nearer to the eye [m]; infinite where nothing is seen.
    pub nearest: f64,
}

/// What is met at a sample.
pub struct Met {
    /// Unit normal [–].
    pub normal: [f32; 3],
    /// Radius [m].
    pub radius: f64,
    /// Number in the list of spheres, or after these, in that of rods.
    pub number: usize,
    /// The body that it is a part of, see [`super::joined_bodies`].
    pub body: Option<u32>,
}

impl Depths {
    /// Distance of what is at a sample [m]; infinite where there is nothing, and in rows that are not held.
    pub fn depth(&self, sample: usize) -> f32 {
        self.depth.get(sample.wrapping_sub(self.first)).copied().unwrap_or(f32::INFINITY)
    }

    /// What is at a sample, or [`NOTHING`]: a number that samples of the same sphere or rod share.
    pub fn ball(&self, sample: usize) -> u32 {
        self.ball.get(sample.wrapping_sub(self.first)).copied().unwrap_or(NOTHING)
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

/// Sorts all spheres and rods into tiles; no row is drawn yet.
pub fn splat(spheres: &Joined, rods: &[Rod], lens: &Lens) -> Depths {
    let seen = |(number, rod): (usize, &Rod)| Some((SeenRod::new(rod, lens)?, number as u32));
    let rods: Vec<(SeenRod, u32)> = rods.iter().enumerate().filter_map(seen).collect();
    let ball = |i: usize| Ball::seen(spheres, i, lens);
    let near = |i: usize| ball(i).map_or(f64::INFINITY, |ball| ball.centre[2] - ball.radius);
    let nearest = (0..spheres.len()).into_par_iter().map(near).reduce(|| f64::INFINITY, f64::min);
    let lists = if spheres.len() == 0 && rods.is_empty() {
        [Vec::new(), Vec::new()]
    } else {
        [
            by_tile(spheres.len(), |i| ball(i).map(|ball| ball.window), lens.size),
            by_tile(rods.len(), |i| Some(rods[i].0.window), lens.size),
        ]
    };
    Depths {
        depth: Vec::new(),
        ball: Vec::new(),
        first: 0,
        drawn: 0,
        lists,
        spheres: spheres.len(),
        nearest: rods.iter().map(|(rod, _)| rod.nearest()).fold(nearest, f64::min),
        rods,
    }
}

impl Depths {
    /// Holds these rows of samples, from one to before another, and no row above them: rows that were let go are not
    /// drawn again.
    pub fn hold(&mut self, [from, to]: [usize; 2], spheres: &Joined, lens: &Lens) {
        let [width, height] = lens.size;
        if self.lists[0].is_empty() {
            return;
        }
        let above = (from * width).saturating_sub(self.first).min(self.depth.len());
        self.depth.drain(..above);
        self.ball.drain(..above);
        self.first += above;
        let rows = to.min(height).div_ceil(TILE);
        let across = width.div_ceil(TILE);
        let more = width * (rows * TILE).min(height).saturating_sub(self.drawn * TILE);
        self.depth.reserve_exact(more);
        self.ball.reserve_exact(more);
        for row in self.drawn..rows {
            let numbers = row * across..(row + 1) * across;
            let draw = |number| self.tile(number, spheres, lens);
            let tiles: Vec<Tile> = numbers.clone().into_par_iter().map(draw).collect();
            let [_, _, top, bottom] = tiles[0].area;
            for y in 0..bottom - top {
                tiles.iter().for_each(|tile| tile.add_row(y, &mut self.depth, &mut self.ball));
            }
            for lists in &mut self.lists {
                lists[numbers.clone()].iter_mut().for_each(|list| *list = Vec::new());
            }
        }
        self.drawn = self.drawn.max(rows);
    }

    /// The distances of all samples that are held [m], row by row.
    pub fn all(self) -> Vec<f32> {
        self.depth
    }

    /// Draws a tile.
    fn tile(&self, number: usize, spheres: &Joined, lens: &Lens) -> Tile {
        let [width, height] = lens.size;
        let across = width.div_ceil(TILE);
        let [left, top] = [number % across * TILE, number / across * TILE];
        let mut tile = Tile::new([left, (left + TILE).min(width), top, (top + TILE).min(height)]);
        tile.draw(spheres, &self.lists[0][number], lens);
        for &rod in &self.lists[1][number] {
            tile.draw_rod(&self.rods[rod as usize].0, spheres.len() as u32 + rod, lens);
        }
        tile
    }
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

struct Tile {
    depth: Vec<f32>,
    ball: Vec<u32>,
    /// Its samples: columns from one to before another, and rows.
    area: [usize; 4],
}

impl Tile {
    fn new(area: [usize; 4]) -> Tile {
        let samples = (area[1] - area[0]) * (area[3] - area[2]);
        Tile { depth: vec![f32::INFINITY; samples], ball: vec![NOTHING; samples], area }
    }

    /// Adds one of its rows, counted from its top, to those of the picture.
    fn add_row(&self, y: usize, depth: &mut Vec<f32>, ball: &mut Vec<u32>) {
        let width = self.area[1] - self.area[0];
        depth.extend_from_slice(&self.depth[y * width..][..width]);
        ball.extend_from_slice(&self.ball[y * width..][..width]);
    }

    fn draw(&mut self, spheres: &Joined, list: &[u32], lens: &Lens) {
        let near = |&i: &u32| (lens.seen(spheres.at(i as usize))[2] - spheres.radius(i as usize), i);
        let mut list: Vec<(f64, u32)> = list.iter().map(near).collect();
        list.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut behind = f32::INFINITY;
        for (n, &(near, number)) in list.iter().enumerate() {
            if n % 64 == 63 {
                behind = self.depth.iter().copied().fold(0.0, f32::max);
            }
            if near as f32 > behind {
                return; // all others are farther still
            }
            if let Some(ball) = Ball::seen(spheres, number as usize, lens) {
                self.draw_ball(&ball, number, lens);
            }
        }
    }

    /// Columns and rows of the tile that a window covers.
    fn part(&self, [bx0, bx1, by0, by1]: [f64; 4]) -> [usize; 4] {
        let [x0, x1, y0, y1] = self.area;
        let from = |sample: f64, low: usize| (sample.ceil().max(0.0) as usize).max(low);
        let to = |sample: f64, high: usize| ((sample.floor().max(-1.0) + 1.0) as usize).min(high);
        [from(bx0 - 0.5, x0), to(bx1 - 0.5, x1), from(by0 - 0.5, y0), to(by1 - 0.5, y1)]
    }

    /// Sets each sample of a window to what `depth` finds there, where that is nearer: x/z and y/z of the sample.
    fn fill(&mut self, window: [f64; 4], number: u32, lens: &Lens, depth: impl Fn(f64, f64) -> Option<f64>) {
        let [left, right, top, bottom] = self.part(window);
        let [x0, x1, y0, _] = self.area;
        for y in top..bottom {
            let dy = (lens.centre[1] - (y as f64 + 0.5)) / lens.focal;
            let base = (y - y0) * (x1 - x0);
            for x in left..right {
                let dx = (x as f64 + 0.5 - lens.centre[0]) / lens.focal;
                let Some(depth) = depth(dx, dy) else { continue };
                let place = base + x - x0;
                if (depth as f32) < self.depth[place] {
                    self.depth[place] = depth as f32;
                    self.ball[place] = number;
                }
            }
        }
    }

    fn draw_rod(&mut self, rod: &SeenRod, number: u32, lens: &Lens) {
        self.fill(rod.window, number, lens, |dx, dy| rod.depth(dx, dy));
    }

    fn draw_ball(&mut self, ball: &Ball, number: u32, lens: &Lens) {
        let [cx, cy, cz] = ball.centre;
        let outside = cx * cx + cy * cy + cz * cz - ball.radius * ball.radius;
        self.fill(ball.window, number, lens, |dx, dy| {
            let (a, b) = (dx * dx + dy * dy + 1.0, dx * cx + dy * cy + cz);
            let inside = b * b - a * outside;
            (inside >= 0.0).then(|| (b - inside.sqrt()) / a)
        });
    }
}

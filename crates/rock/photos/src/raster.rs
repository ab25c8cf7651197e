//! True and false pixels: growing, shrinking, the largest region, holes.

mod regions;
mod within;

use regions::Regions;
use std::ops::Range;
pub(crate) use within::Nearby;
pub use within::WIDEST;

/// A picture of true and false.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Raster {
    /// Pixels of a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Row by row.
    pub pixels: Vec<bool>,
}

impl Raster {
    /// Pixels that are true.
    pub fn count(&self) -> usize {
        self.pixels.iter().filter(|p| **p).count()
    }

    /// Pixels that are true and lie on the frame.
    pub fn on_frame(&self) -> usize {
        self.frame().filter(|k| self.pixels[*k]).count()
    }

    /// Numbers of the pixels of the frame, each once.
    pub fn frame(&self) -> impl Iterator<Item = usize> + use<> {
        let (w, h) = (self.width, self.height);
        let rows = (0..w).chain(if h > 1 { (h - 1) * w..h * w } else { 0..0 });
        let sides = (1..h.saturating_sub(1)).flat_map(move |y| {
            let last = if w > 1 { Some(y * w + w - 1) } else { None };
            std::iter::once(y * w).chain(last)
        });
        rows.chain(sides)
    }

    /// True where a true pixel is within `radius` [px].
    pub fn grown(&self, radius: f64) -> Raster {
        self.like(Nearby::new(self, true).within(radius))
    }

    /// True where no false pixel is within `radius` [px]; beyond the frame all is as on it.
    pub fn shrunk(&self, radius: f64) -> Raster {
        let near = Nearby::new(self, false).within(radius);
        self.like(near.into_iter().map(|near| !near).collect())
    }

    /// Without what is narrower than about twice `radius` [px].
    pub fn opened(&self, radius: f64) -> Raster {
        if radius > 0.0 { self.shrunk(radius).grown(radius) } else { self.clone() }
    }

    /// Without gaps that are narrower than about twice `radius` [px].
    pub fn closed(&self, radius: f64) -> Raster {
        if radius > 0.0 {
            // With room beyond the frame: what grows up to it would not shrink again.
            let room = radius as usize + 2;
            self.with_room(room).grown(radius).shrunk(radius).without_room(room)
        } else {
            self.clone()
        }
    }

    /// With false pixels around it.
    fn with_room(&self, room: usize) -> Raster {
        let (width, height) = (self.width + 2 * room, self.height + 2 * room);
        let mut pixels = vec![false; width * height];
        for (y, row) in self.pixels.chunks(self.width).enumerate() {
            let at = (y + room) * width + room;
            pixels[at..at + self.width].copy_from_slice(row);
        }
        Raster { width, height, pixels }
    }

    fn without_room(&self, room: usize) -> Raster {
        let (width, height) = (self.width - 2 * room, self.height - 2 * room);
        let rows = self.pixels.chunks(self.width).skip(room).take(height);
        Raster { width, height, pixels: rows.flat_map(|row| row[room..room + width].to_vec()).collect() }
    }

    /// The largest region of true pixels that share sides, and the pixels of the others.
    pub fn largest(&self) -> (Raster, usize) {
        let regions = Regions::new(self, true);
        let largest = regions.largest();
        let kept = self.like(regions.drawn(|region| Some(region) == largest));
        let rest = self.count() - kept.count();
        (kept, rest)
    }

    /// False regions that do not touch the frame become true.
    pub fn filled(&self) -> Raster {
        let regions = Regions::new(self, false);
        let open = regions.on_frame();
        let left = regions.drawn(|region| open[region]);
        self.like(left.into_iter().map(|left| !left).collect())
    }

    /// The rows from the first to the last that have a true pixel.
    pub fn rows(&self) -> Range<usize> {
        let [first, last] = [self.pixels.iter().position(|p| *p), self.pixels.iter().rposition(|p| *p)];
        first.zip(last).map_or(0..0, |(first, last)| first / self.width..last / self.width + 1)
    }

    /// Of the same size.
    pub(crate) fn like(&self, pixels: Vec<bool>) -> Raster {
        Raster { pixels, ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn raster(rows: &[&str]) -> Raster {
        let pixels = rows.iter().flat_map(|r| r.chars().map(|c| c == '#')).collect();
        Raster { width: rows[0].len(), height: rows.len(), pixels }
    }

    #[test]
    fn the_largest_region_stays_and_its_hole_closes() {
        let r = raster(&["#..####", "#..#..#", "...####", "##....."]);
        let (largest, rest) = r.largest();
        assert_eq!((largest.count(), rest), (10, 4));
        assert_eq!(largest.filled().count(), 12);
        // Open to the frame is no hole.
        assert_eq!(raster(&["###", "#.#", "#.#"]).filled().count(), 7);
        assert_eq!(raster(&["...", "..."]).largest().0.count(), 0);
    }

    #[test]
    fn opening_takes_a_thread_and_closing_a_crack() {
        let thread = raster(&["......", ".###..", ".#####", ".###..", "......"]);
        assert_eq!(thread.opened(1.0).count(), 8);
        let crack = raster(&["#####", "##.##", "#####", "#####"]);
        assert_eq!(crack.closed(1.0).count(), 20);
        // Near the frame nothing is added, and what the frame cuts stays.
        let near = raster(&[".....", "..#..", "..#..", "....."]);
        assert_eq!(near.closed(3.0), near);
        let cut = raster(&["##...", "##...", "....."]);
        assert_eq!(cut.closed(2.0), cut);
    }
}

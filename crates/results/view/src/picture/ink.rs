//! Lines, areas and text, drawn into a picture with soft edges.

use super::font;

/// A straight piece of a stroke, from one end to the other [pixel].
pub type Piece = [[f64; 2]; 2];

/// Where the given point of a text lies in it.
#[derive(Clone, Copy)]
pub enum Anchor {
    Left,
    Middle,
    Right,
}

/// Some rows of a picture, drawn into.
pub struct Canvas<'a> {
    /// Width and height of the whole picture [pixel].
    pub size: [u32; 2],
    /// Number of the first row.
    pub top: usize,
    /// Four bytes a pixel.
    pub rgba: &'a mut [u8],
}

impl Canvas<'_> {
    /// The rows that it has, from one to before another.
    fn rows(&self) -> [usize; 2] {
        [self.top, self.top + self.rgba.len() / (4 * self.size[0] as usize)]
    }
}

/// Draws into a picture; what is outside of the rows of its canvas is left out.
pub struct Pen<'a> {
    pub canvas: Canvas<'a>,
    pub colour: [u8; 3],
    /// Of the rim around text.
    pub paper: [u8; 3],
}

impl Pen<'_> {
    /// Text that stands on `at`, its capitals `height` pixels high.
    pub fn text(&mut self, at: [f64; 2], height: f64, anchor: Anchor, text: &str) {
        let shift = match anchor {
            Anchor::Left => 0.0,
            Anchor::Middle => 0.5 * font::width(text, height),
            Anchor::Right => font::width(text, height),
        };
        let rim = 0.15 * height + 0.5;
        let ([first, end], [above, below]) = (self.canvas.rows(), font::reach(height));
        if at[1] - above - rim > end as f64 || at[1] + below + rim < first as f64 - 1.0 {
            return;
        }
        let ink = font::ink(text, height, rim.ceil() as usize);
        let [left, top] =
            [(at[0] - shift).round() as i32 + ink.corner[0], at[1].round() as i32 - ink.corner[1]];
        // A rim of paper keeps text readable on grains.
        let letters = std::mem::replace(&mut self.colour, self.paper);
        let seen = [first, end].map(|row| row as i32 - top);
        self.print([left, top], ink.size, &widened(&ink, rim, seen));
        self.colour = letters;
        self.print([left, top], ink.size, &ink.shares);
    }

    /// Inks the shares of pixels, row by row, from a corner on.
    fn print(&mut self, [left, top]: [i32; 2], [wide, _]: [usize; 2], shares: &[f64]) {
        let [first, end] = self.canvas.rows();
        for (n, share) in shares.iter().enumerate().filter(|(_, share)| **share > 0.0) {
            let [x, y] = [left + (n % wide) as i32, top + (n / wide) as i32].map(|v| usize::try_from(v).ok());
            if let (Some(x), Some(y)) = (x, y)
                && x < self.canvas.size[0] as usize
                && (first..end).contains(&y)
            {
                self.blend(x, y, *share);
            }
        }
    }

    /// Straight pieces with round ends, inked once where they meet.
    pub fn strokes(&mut self, pieces: &[Piece], width: f64) {
        let reach = 0.5 * width + 1.0;
        let ends = || pieces.iter().flatten();
        let low = |k: usize| ends().map(|p| p[k] - reach).fold(f64::INFINITY, f64::min).max(0.0) as usize;
        let high = |k: usize, size: u32| {
            ends().map(|p| p[k] + reach).fold(0.0, f64::max).ceil().min(f64::from(size)) as usize
        };
        let [top, bottom] = self.canvas.rows();
        let [x0, y0] = [low(0), low(1).max(top)];
        let [x1, y1] = [high(0, self.canvas.size[0]), high(1, self.canvas.size[1]).min(bottom)];
        if x0 >= x1 || y0 >= y1 {
            return;
        }
        let mut ink = vec![0f64; (x1 - x0) * (y1 - y0)];
        for piece in pieces {
            let span = |k: usize, from: usize, to: usize| {
                let [a, b] = [piece[0][k].min(piece[1][k]), piece[0][k].max(piece[1][k])];
                ((a - reach).max(from as f64) as usize)
                    ..((b + reach).ceil().clamp(from as f64, to as f64) as usize)
            };
            for y in span(1, y0, y1) {
                for x in span(0, x0, x1) {
                    let cover = 0.5 + 0.5 * width - distance([x as f64 + 0.5, y as f64 + 0.5], *piece);
                    let place = &mut ink[(y - y0) * (x1 - x0) + x - x0];
                    *place = place.max(cover.clamp(0.0, 1.0));
                }
            }
        }
        for y in y0..y1 {
            for x in x0..x1 {
                self.blend(x, y, ink[(y - y0) * (x1 - x0) + x - x0]);
            }
        }
    }

    /// A filled rectangle: left, top, right, bottom [pixel].
    pub fn fill(&mut self, area: [f64; 4]) {
        let [x0, y0, x1, y1] = area.map(|v| v.round().max(0.0) as usize);
        let [top, bottom] = self.canvas.rows();
        for y in y0.max(top)..y1.min(bottom) {
            for x in x0..x1.min(self.canvas.size[0] as usize) {
                self.blend(x, y, 1.0);
            }
        }
    }

    fn blend(&mut self, x: usize, y: usize, share: f64) {
        let at = 4 * ((y - self.canvas.top) * self.canvas.size[0] as usize + x);
        for k in 0..3 {
            let under = f64::from(self.canvas.rgba[at + k]);
            self.canvas.rgba[at + k] = (under + share * (f64::from(self.colour[k]) - under)).round() as u8;
        }
    }
}

/// The ink with all that is nearer to it than a distance [pixel], in the rows from one to before another.
fn widened(ink: &font::Ink, distance: f64, [first, end]: [i32; 2]) -> Vec<f64> {
    let [wide, high] = ink.size.map(|n| n as i32);
    let [first, end] = [first, end].map(|row| row.clamp(0, high));
    let reach = distance.ceil() as i32;
    let disc: Vec<(i32, i32, f64)> = (-reach..=reach)
        .flat_map(|dy| (-reach..=reach).map(move |dx| (dx, dy)))
        .map(|(dx, dy)| (dx, dy, (distance + 0.5 - f64::from(dx).hypot(f64::from(dy))).clamp(0.0, 1.0)))
        .filter(|(.., share)| *share > 0.0)
        .collect();
    // Where all of four neighbours are ink, one of them is nearer to any other pixel.
    let row = wide as usize;
    let beside = |n: usize| [n.wrapping_sub(1), n + 1, n.wrapping_sub(row), n + row];
    let whole = |n: usize| ink.shares.get(n).is_some_and(|share| *share == 1.0);
    let inside = |n: usize| whole(n) && beside(n).into_iter().all(whole);
    let mut all = ink.shares.clone();
    let rows = (first - reach).max(0)..(end + reach).min(high);
    for n in (rows.start * wide) as usize..(rows.end * wide).max(rows.start * wide) as usize {
        let share = ink.shares[n];
        if share == 0.0 || inside(n) {
            continue;
        }
        let [x, y] = [n as i32 % wide, n as i32 / wide];
        for (dx, dy, near) in &disc {
            let [x, y] = [x + dx, y + dy];
            if (0..wide).contains(&x) && (first..end).contains(&y) {
                let place = &mut all[(y * wide + x) as usize];
                *place = place.max(share * near);
            }
        }
    }
    all
}

/// From a point to the nearest of a straight piece.
fn distance(point: [f64; 2], [a, b]: Piece) -> f64 {
    let along = [b[0] - a[0], b[1] - a[1]];
    let from = [point[0] - a[0], point[1] - a[1]];
    let length = along[0] * along[0] + along[1] * along[1];
    let t =
        if length > 0.0 { ((from[0] * along[0] + from[1] * along[1]) / length).clamp(0.0, 1.0) } else { 0.0 };
    (from[0] - t * along[0]).hypot(from[1] - t * along[1])
}

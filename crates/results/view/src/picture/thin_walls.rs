//! Thin walls in a picture, drawn from the farthest to the nearest, each over what is behind it. Where coloured opaque walls overlap, only the
//! nearest is drawn at each sample.

use super::{
    lens::{Lens, SAMPLES},
    options::PictureOptions,
    paint::Pane,
    shadow::{LAMP, Shadow},
    splat::{Depths, Met},
    theme::Theme,
    veil::Veil,
};
use crate::appearance::colour;
use geom::Vec3;
use rayon::prelude::*;

/// Rows of samples that are drawn together.
const BAND: usize = 16;

/// Nearest distance drawn, as a share of the distance of what is looked at [–].
const NEAREST: f64 = 1e-3;

/// Width of a line [pixel].
const LINE: f64 = 1.3;

/// Least opacity of a shadow on a face [–].
const SHADOW: f32 = 0.6;

/// Share by which light and shadow change a colour less where it shows a value [–].
const COLOURED: f32 = 0.6;

/// How much farther than a face the lines on it may be, as a share [–].
const ON_FACE: f64 = 2e-3;

/// A triangle on the picture.
struct Piece {
    /// Column and row [sample], and 1/z [1/m], which is linear on the picture.
    corner: [[f64; 3]; 3],
    /// Brightness and opacity [–].
    tone: [f32; 2],
    /// Its colour in full light.
    colour: [f32; 3],
    /// Whether the colour shows a value: light changes it less.
    coloured: bool,
    /// Largest 1/z that is drawn [1/m]: nothing nearer to the eye.
    farthest: f64,
    /// Planes before or behind all grains are before or behind all meshes too: 0 behind, 1 mesh, 2 before.
    rank: u8,
    /// Mean 1/z, for the order of the rest.
    near: f64,
    /// Whether it is part of a face, on which shadows fall.
    face: bool,
    /// Whether it is of a plane: ground, which does not show through the wall spheres before it.
    plane: bool,
}

/// All thin walls in a picture.
pub struct ThinWalls {
    pieces: Vec<Piece>,
    /// Between the grains and the wall spheres, and before both, for the rows that are held; empty without thin walls.
    veils: Vec<[Veil; 2]>,
    /// The first sample that is held.
    first: usize,
    /// How much darker a face is in a shadow [–].
    shade: f32,
    /// Whether any piece hides all behind it.
    any_solid: bool,
}

impl ThinWalls {
    /// Prepares `panes`; no row of samples is drawn yet.
    pub fn new(panes: &[Pane], lens: &Lens, options: &PictureOptions) -> ThinWalls {
        let shade = Theme::of(options.dark).shade;
        let pieces = pieces(panes, lens, options);
        let any_solid = pieces.iter().any(Piece::is_solid);
        ThinWalls { pieces, veils: Vec::new(), first: 0, shade, any_solid }
    }

    /// Draws these rows of samples, from one to before another, and lets others go: panes where they are nearer than
    /// `solid`, and apart where they are nearer than `glass` too. On their faces lies the `shadow` of what is solid.
    pub fn hold(
        &mut self,
        [from, to]: [usize; 2],
        lens: &Lens,
        [solid, glass]: [&Depths; 2],
        shadow: &Shadow,
    ) {
        let (ThinWalls { pieces, shade, any_solid, .. }, width) = (&*self, lens.size[0]);
        if pieces.is_empty() {
            return;
        }
        let mut veils = vec![[Veil::default(); 2]; width * (to - from)];
        veils.par_chunks_mut(width * BAND).enumerate().for_each(|(n, band)| {
            let first = from + n * BAND;
            let rows = [first, first + band.len() / width];
            // Nearest of what hides all behind it: 1/z [1/m].
            let mut nearest = vec![0.0f64; if *any_solid { band.len() } else { 0 }];
            for piece in pieces.iter().filter(|piece| piece.is_solid()) {
                piece.fill(rows, width, |at, inverse| {
                    let (depth, own) = ((1.0 / inverse) as f32, at - rows[0] * width);
                    if inverse <= piece.farthest && depth < solid.depth(at) && inverse > nearest[own] {
                        nearest[own] = inverse;
                        let (colour, hides) = piece.shaded(shadow, lens, at, 1.0 / inverse, *shade);
                        band[own] = Default::default();
                        band[own][usize::from(depth < glass.depth(at))].lay(colour, hides);
                    }
                });
            }
            for piece in pieces.iter().filter(|piece| !piece.is_solid()) {
                let slack = if piece.face { 1.0 } else { 1.0 + ON_FACE };
                piece.fill(rows, width, |at, inverse| {
                    let (depth, own) = ((1.0 / inverse) as f32, at - rows[0] * width);
                    let hidden = nearest.get(own).is_some_and(|nearest| inverse * slack < *nearest);
                    if !hidden && inverse <= piece.farthest && depth < solid.depth(at) {
                        let before = usize::from(depth < glass.depth(at));
                        if piece.plane && before == 0 {
                            return;
                        }
                        let (colour, hides) = piece.shaded(shadow, lens, at, 1.0 / inverse, *shade);
                        band[own][before].lay(colour, hides);
                    }
                });
            }
        });
        (self.veils, self.first) = (veils, from * width);
    }

    /// A colour as seen through what is between grains and wall spheres.
    pub fn behind(&self, sample: usize, under: [f32; 3]) -> [f32; 3] {
        self.veils.get(sample.wrapping_sub(self.first)).map_or(under, |v| v[0].over(under))
    }

    /// A colour as seen through what is before both.
    pub fn before(&self, sample: usize, under: [f32; 3]) -> [f32; 3] {
        self.veils.get(sample.wrapping_sub(self.first)).map_or(under, |v| v[1].over(under))
    }
}

/// The triangles to draw, the farthest first.
fn pieces(panes: &[Pane], lens: &Lens, options: &PictureOptions) -> Vec<Piece> {
    let (mut pieces, theme) = (Vec::new(), Theme::of(options.dark));
    for pane in panes {
        let most = if pane.side.is_some() { theme.ground } else { 1.0 };
        let first = pieces.len();
        for (number, face) in pane.faces.iter().enumerate() {
            let worn = pane.colour.as_ref().and_then(|colour| colour.get(number)).copied();
            let seen = face.map(|p| lens.seen(p));
            let opacity = if worn.is_some() { options.coloured_opacity } else { options.wall_opacity };
            let tone = [brightness(seen), if pane.opaque { 1.0 } else { most.min(opacity as f32) }];
            let cut = before_the_eye(&seen, NEAREST * lens.distance);
            let on: Vec<[f64; 3]> = cut.iter().map(|p| projected(*p, lens)).collect();
            let part = |n: usize| Piece {
                face: true,
                coloured: worn.is_some(),
                colour: worn.unwrap_or_else(|| colour::fraction(colour::WALL)),
                ..Piece::new([on[0], on[n - 1], on[n]], tone)
            };
            pieces.extend((2..on.len()).map(part));
        }
        for line in &pane.lines {
            let ends = before_the_eye(&line.map(|p| lens.seen(p)), NEAREST * lens.distance);
            if let [a, b, ..] = ends[..] {
                pieces.extend(stroke(projected(a, lens), projected(b, lens), [theme.line, pane.ink]));
            }
        }
        // A plane whose grains are on the eye's side hides none of them: a floor stays whole.
        let faces_away = |[point, normal]: [Vec3; 2]| (lens.eye - point).dot(&normal) < 0.0;
        let rank = pane.side.map_or(1, |side| if faces_away(side) { 2 } else { 0 });
        let farthest = if options.cut && rank > 0 { 1.0 / lens.distance } else { f64::INFINITY };
        for piece in &mut pieces[first..] {
            (piece.rank, piece.farthest, piece.plane) = (rank, farthest, pane.side.is_some());
        }
    }
    pieces.sort_by(|a, b| a.rank.cmp(&b.rank).then(a.near.total_cmp(&b.near)));
    pieces
}

/// Clips a polygon or a line at `nearest` [m] from the eye.
fn before_the_eye(polygon: &[[f64; 3]], nearest: f64) -> Vec<[f64; 3]> {
    let mut kept = Vec::new();
    for (n, a) in polygon.iter().enumerate() {
        let b = polygon[(n + 1) % polygon.len()];
        if a[2] >= nearest {
            kept.push(*a);
        }
        let closes = polygon.len() == 2 && n == 1;
        if (a[2] >= nearest) != (b[2] >= nearest) && !closes {
            let share = (nearest - a[2]) / (b[2] - a[2]);
            kept.push(std::array::from_fn(|k| a[k] + share * (b[k] - a[k])));
        }
    }
    kept
}

fn projected([x, y, z]: [f64; 3], lens: &Lens) -> [f64; 3] {
    [lens.centre[0] + lens.focal * x / z, lens.centre[1] - lens.focal * y / z, 1.0 / z]
}

/// A line as two triangles.
fn stroke(a: [f64; 3], b: [f64; 3], tone: [f32; 2]) -> Vec<Piece> {
    let length = (b[0] - a[0]).hypot(b[1] - a[1]).max(1e-9);
    let half = 0.5 * LINE * SAMPLES as f64 / length;
    let [dx, dy] = [half * (b[1] - a[1]), half * (a[0] - b[0])];
    let aside = |p: [f64; 3], side: f64| [p[0] + side * dx, p[1] + side * dy, p[2]];
    let [p, q, r, s] = [aside(a, 1.0), aside(a, -1.0), aside(b, -1.0), aside(b, 1.0)];
    [[p, q, r], [p, r, s]].map(|corner| Piece::new(corner, tone)).into()
}

/// The light on the side of a face that is seen.
fn brightness(seen: [[f64; 3]; 3]) -> f32 {
    let [a, b, c] = seen.map(Vec3::from);
    let normal = (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_default();
    let normal = if normal.dot(&a) > 0.0 { -normal } else { normal };
    let lamp: f32 = (0..3).map(|k| normal[k] as f32 * LAMP[k]).sum();
    0.64 + 0.14 * normal.y as f32 + 0.38 * lamp.max(0.0)
}

impl Piece {
    fn new(corner: [[f64; 3]; 3], tone: [f32; 2]) -> Piece {
        Piece {
            corner,
            tone,
            colour: colour::fraction(colour::WALL),
            coloured: false,
            farthest: f64::INFINITY,
            rank: 1,
            face: false,
            plane: false,
            near: corner.iter().map(|c| c[2]).sum::<f64>() / 3.0,
        }
    }

    /// Whether it is a coloured, opaque face.
    fn is_solid(&self) -> bool {
        self.coloured && self.face && self.tone[1] >= 0.999
    }

    /// Its lit colour at a sample, and how much it hides: darker and thicker in a shadow.
    fn shaded(&self, shadow: &Shadow, lens: &Lens, at: usize, depth: f64, shade: f32) -> ([f32; 3], f32) {
        let lit = |[bright, hides]: [f32; 2]| {
            let bright = if self.coloured { bright + COLOURED * (1.0 - bright) } else { bright };
            (self.colour.map(|c| (c * bright).min(1.0)), hides)
        };
        if !self.face {
            return lit(self.tone);
        }
        let sample = [at % lens.size[0], at / lens.size[0]];
        let met = Met { normal: [0.0; 3], radius: 0.0, number: 0, body: None };
        let dark = 1.0 - shadow.lit(lens, lens.at(sample, depth), &met, sample);
        let [bright, hides] = self.tone;
        lit([bright * (1.0 - shade * dark), hides + dark * (SHADOW - hides).max(0.0)])
    }

    /// Calls `paint` with the number and 1/z of every sample inside, in the rows given. A sample on the common edge of
    /// two triangles belongs to one of them.
    fn fill(&self, rows: [usize; 2], width: usize, mut paint: impl FnMut(usize, f64)) {
        let [a, b, c] = self.corner;
        let twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if twice == 0.0 || !twice.is_finite() {
            return;
        }
        let low = |k: usize| self.corner.iter().map(|p| p[k]).fold(f64::INFINITY, f64::min);
        let high = |k: usize| self.corner.iter().map(|p| p[k]).fold(f64::NEG_INFINITY, f64::max);
        let first = rows[0].max((low(1) - 0.5).ceil().max(0.0) as usize);
        let last = rows[1].min((high(1) + 0.5).ceil().max(0.0) as usize);
        // 1/z and where the sides are, as linear functions of the column in a row.
        let slope = ((b[2] - a[2]) * (c[1] - a[1]) - (c[2] - a[2]) * (b[1] - a[1])) / twice;
        let fall = ((c[2] - a[2]) * (b[0] - a[0]) - (b[2] - a[2]) * (c[0] - a[0])) / twice;
        for row in first..last {
            let y = row as f64 + 0.5;
            let Some([left, right]) = self.span(y) else { continue };
            let from = (left - 0.5).ceil().max(0.0) as usize;
            let to = ((right - 0.5).ceil().max(0.0) as usize).min(width);
            for column in from..to {
                let x = column as f64 + 0.5;
                paint(row * width + column, a[2] + slope * (x - a[0]) + fall * (y - a[1]));
            }
        }
    }

    /// Where the sides meet a row, left and right.
    fn span(&self, y: f64) -> Option<[f64; 2]> {
        let mut ends: Option<[f64; 2]> = None;
        for n in 0..3 {
            // From the upper end to the lower, so that two triangles compute a common side alike.
            let [p, q] = [self.corner[n], self.corner[(n + 1) % 3]];
            let [p, q] = if (p[1], p[0]) <= (q[1], q[0]) { [p, q] } else { [q, p] };
            if p[1] <= y && y < q[1] {
                let x = p[0] + (q[0] - p[0]) * ((y - p[1]) / (q[1] - p[1]));
                ends = Some(ends.map_or([x, x], |[l, r]| [l.min(x), r.max(x)]));
            }
        }
        ends
    }
}

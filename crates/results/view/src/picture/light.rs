//! Light: a lamp over the left shoulder that casts shadows, a bright sky, less of it in the gaps between grains, and its
//! reflection, by which dark grains show their shape too.

use super::{
    joined::Joined,
    joined_bodies::JoinedBodies,
    lens::{Lens, SAMPLES},
    options::PictureOptions,
    paint::{Painted, PaintedLayer},
    rod::Rod,
    shadow::{LAMP, Shadow},
    splat::{Depths, Met, NOTHING, splat},
    theme::Theme,
    thin_walls::ThinWalls,
};
use crate::Role;
use geom::Vec3;
use rayon::prelude::*;

/// All samples of a pixel.
const ALL: [usize; SAMPLES * SAMPLES] = [0, 1, 2, 3];

/// Two of them, far apart.
const TWO: [usize; 2] = [0, 3];

/// Places looked at around a sample for what covers it: a spiral, as shares of the reach.
const SPIRAL: [[f32; 2]; 8] = [
    [0.09, 0.05],
    [-0.16, 0.14],
    [-0.05, -0.33],
    [0.42, 0.12],
    [0.10, 0.55],
    [-0.66, 0.08],
    [0.22, -0.76],
    [0.69, 0.66],
];

/// One kind of surface in the picture, with what is needed to light it.
struct Shaded<'a> {
    depths: Depths,
    /// What it keeps the lamp's light from.
    shadow: Shadow,
    spheres: Joined<'a>,
    /// Their numbers follow those of the spheres.
    rods: Vec<Rod>,
    /// Which of them are one body.
    joined: JoinedBodies,
    /// How far around a sample shade is looked for [m].
    reach: f64,
}

/// Rows of pixels that are made together: all that is held of a picture, with what is around them.
const ROWS: usize = 64;

/// How far around a sample shade is looked for at most, as a share of the height of the picture [–].
const FARTHEST: f64 = 0.06;

/// How much of what is behind it a grain beside force chains hides [–].
const FAINT: f64 = 0.22;

/// Draws everything on white, from the top down; `each` takes some rows, the first of which has the number given, with
/// four bytes a pixel.
pub fn render<E>(
    painted: &Painted,
    lens: &Lens,
    options: &PictureOptions,
    mut each: impl FnMut(usize, Vec<u8>) -> Result<(), E>,
) -> Result<(), E> {
    let no_rods = painted.rods.is_empty() && painted.lines.is_empty();
    let walls_only = no_rods && painted.layers.iter().all(|l| l.role == Role::Walls);
    let faint = painted.chains.is_some();
    let opacity = |l: &PaintedLayer| match l.role {
        Role::Walls if walls_only => 1.0,
        Role::Walls if l.worn => options.coloured_opacity,
        Role::Walls => options.wall_opacity,
        Role::Grains if faint => FAINT,
        _ => 1.0,
    };
    let see_through = |l: &&PaintedLayer| opacity(l) < 1.0;
    let (glass, solid): (Vec<&PaintedLayer>, Vec<&PaintedLayer>) =
        painted.layers.iter().partition(see_through);
    let keep = options.cut.then_some(|place: Vec3| lens.seen(place)[2] >= lens.distance);
    let extent = painted.ball();
    let of_walls = glass.iter().find(|l| l.role == Role::Walls).map_or(1.0, |layer| opacity(layer));
    let mut solid = Shaded::new(&solid, [&painted.rods, &painted.lines], lens, extent, keep);
    let mut glass = Shaded::new(&glass, [&[], &[]], lens, extent, keep);
    let mut walls = ThinWalls::new(&painted.panes, lens, options);
    let (opacity, theme) = (of_walls as f32, Theme::of(options.dark));
    let (width, height) = (options.width as usize, options.height as usize);
    for top in (0..height).step_by(ROWS) {
        let rows = [top, (top + ROWS).min(height)].map(|row| row * SAMPLES);
        solid.hold(rows, lens);
        glass.hold(rows, lens);
        walls.hold(rows, lens, [&solid.depths, &glass.depths], &solid.shadow);
        let (solid, glass, walls) = (&solid, &glass, &walls);
        let mut rgba = vec![255u8; width * (rows[1] - rows[0]) / SAMPLES * 4];
        rgba.par_chunks_mut(width * 4).enumerate().for_each(|(n, row)| {
            let y = top + n;
            for (x, pixel) in row.chunks_exact_mut(4).enumerate() {
                let samples = if whole(&solid.depths, &glass.depths, lens, [x, y]) { &TWO[..] } else { &ALL };
                let mut sum = [0f32; 3];
                for sample in samples {
                    let at = [x * SAMPLES + sample % SAMPLES, y * SAMPLES + sample / SAMPLES];
                    let seen = through([solid, glass], walls, lens, at, (opacity, theme));
                    sum = std::array::from_fn(|k| sum[k] + seen[k]);
                }
                for k in 0..3 {
                    pixel[k] = (sum[k] * 255.0 / samples.len() as f32 + 0.5).clamp(0.0, 255.0) as u8;
                }
            }
        });
        each(top, rgba)?;
    }
    Ok(())
}

/// How far around a sample at this depth [m] shade is looked for, where it is looked for over `reach` [m]; [sample].
fn reach_on(lens: &Lens, reach: f64, depth: f64) -> f64 {
    let most = FARTHEST * lens.size[1] as f64;
    if depth > 0.0 { (reach * lens.focal / depth).clamp(4.0, most) } else { most }
}

/// Whether all samples of a pixel see the same sphere: then there is no edge to smooth.
fn whole(solid: &Depths, glass: &Depths, lens: &Lens, [x, y]: [usize; 2]) -> bool {
    let place =
        |sample: &usize| (y * SAMPLES + sample / SAMPLES) * lens.size[0] + x * SAMPLES + sample % SAMPLES;
    let seen = |sample: &usize| [solid, glass].map(|depths| depths.ball(place(sample)));
    let first = seen(&ALL[0]);
    first != [NOTHING; 2] && ALL.iter().all(|sample| seen(sample) == first)
}

/// The colour of one sample: grains, and walls before or behind them.
fn through(
    [solid, glass]: [&Shaded; 2],
    walls: &ThinWalls,
    lens: &Lens,
    at: [usize; 2],
    (opacity, theme): (f32, Theme),
) -> [f32; 3] {
    let place = at[1] * lens.size[0] + at[0];
    let grain = solid.colour(lens, at, None).map(|(colour, edge)| theme.lit(colour, edge));
    let mut seen = walls.behind(place, grain.unwrap_or(theme.paper));
    if glass.depths.depth(place) < solid.depths.depth(place)
        && let Some((wall, _)) = glass.colour(lens, at, Some(&solid.shadow))
    {
        let share = match grain {
            _ if glass.is_grain(place) => FAINT as f32,
            Some(_) => opacity,
            None => theme.wall + (1.0 - theme.wall) * opacity,
        };
        seen = std::array::from_fn(|k| seen[k] + share * (wall[k] - seen[k]));
    }
    walls.before(place, seen)
}

impl<'a> Shaded<'a> {
    /// The surfaces of all `layers` together; walls only where `keep` holds for their place. Thin `lines` cast no shadow.
    fn new(
        layers: &[&'a PaintedLayer<'a>],
        [rods, lines]: [&[Rod]; 2],
        lens: &Lens,
        extent: (Vec3, f64),
        keep: Option<impl Fn(Vec3) -> bool + Copy>,
    ) -> Self {
        let spheres = Joined::new(layers, |layer| keep.filter(|_| layer.role == Role::Walls));
        let (mut joined, mut rods) = (JoinedBodies::default(), rods.to_vec());
        let mut of_bodies = vec![None; rods.len()];
        for (layer, first) in spheres.layers() {
            // Only walls lose spheres by `keep`, and they have no bodies.
            let bodies = join_bodies(&mut joined, layer, first, lens);
            for (n, own) in &layer.solids {
                of_bodies.extend(vec![Some(bodies[*n]); own.len()]);
                rods.extend(own);
            }
        }
        for (n, body) in of_bodies.iter().enumerate() {
            body.iter().for_each(|&body| joined.join(spheres.len() + n, body));
        }
        let usual = spheres.usual_radius();
        // First: it lets go of its tiles, of which those of the picture stay.
        let shadow = Shadow::of(&spheres, &rods, &joined, usual, lens, extent);
        rods.extend(lines);
        let depths = splat(&spheres, &rods, lens);
        Shaded { depths, shadow, spheres, rods, joined, reach: 4.0 * usual }
    }

    /// Holds these rows of samples, and those above and below that shade is looked for in.
    fn hold(&mut self, [from, to]: [usize; 2], lens: &Lens) {
        // Depths are kept with seven digits: half a thousandth more is safe.
        let around = (1.0005 * reach_on(lens, self.reach, self.depths.nearest)).ceil() as usize + 1;
        self.depths.hold([from.saturating_sub(around), to + around], &self.spheres, lens);
    }

    /// The lit colour at a sample, and how near to its outline that is; or none where there is nothing. `others` cast
    /// shadows on it too.
    fn colour(&self, lens: &Lens, at: [usize; 2], others: Option<&Shadow>) -> Option<([f32; 3], f32)> {
        let place = at[1] * lens.size[0] + at[0];
        let depth = f64::from(self.depths.depth(place));
        let point = lens.at(at, depth);
        let mut met = self.depths.met(place, point, &self.spheres, lens)?;
        met.body = self.joined.of(met.number);
        met.normal = self.joined.normal(met.number, point).unwrap_or(met.normal);
        let normal = met.normal;
        let facing: f32 = (0..3).map(|k| normal[k] * LAMP[k]).sum();
        let lit = |shadow: &Shadow| shadow.lit(lens, point, &met, at);
        let lit = || lit(&self.shadow).min(others.map_or(1.0, lit));
        let lamp = if facing > 0.0 { facing * lit() } else { 0.0 };
        let open = self.openness(lens, at, point, &met);
        let bright = open * (0.62 + 0.14 * normal[1]) + 0.46 * (0.3 + 0.7 * open) * lamp;
        let rim = (1.0 + normal[2]).clamp(0.0, 1.0).powi(3);
        let sky = open * (0.6 + 0.4 * normal[1]) * (0.10 + 0.22 * rim);
        let gloss = sky + 0.12 * open * lamp.powi(12);
        let own = self.own_colour(met.number);
        // Light colours need no gloss to show their shape.
        let lit = own.map(|c| (c * bright + (1.0 - 0.8 * c) * gloss).min(1.0));
        Some((lit, (1.0 + normal[2]).clamp(0.0, 1.0)))
    }

    /// The colour of a sphere or rod, parts 0 to 1.
    fn own_colour(&self, number: usize) -> [f32; 3] {
        match number.checked_sub(self.spheres.len()) {
            None => self.spheres.colour(number),
            Some(rod) => self.rods[rod].colour,
        }
    }

    /// How much of the sky a sample sees, 0 to 1, judged by what stands around it in the picture; a body does not hide
    /// the sky from itself, which would darken the lines between its spheres.
    fn openness(&self, lens: &Lens, at: [usize; 2], point: [f64; 3], met: &Met) -> f32 {
        let reach = reach_on(lens, self.reach, point[2]) as f32;
        let world = (f64::from(reach) * point[2] / lens.focal) as f32;
        // Each of the four samples of a pixel looks a quarter turn further on, so a pixel looks everywhere.
        let (cos, sin) =
            [(1.0, 0.0), (0.0, 1.0), (-0.707, 0.707), (0.707, 0.707)][at[0] % 2 + 2 * (at[1] % 2)];
        let mut covered = 0.0;
        for [sx, sy] in SPIRAL {
            let x = at[0] as i64 + (reach * (sx * cos - sy * sin)).round() as i64;
            let y = at[1] as i64 + (reach * (sx * sin + sy * cos)).round() as i64;
            if x < 0 || y < 0 || x >= lens.size[0] as i64 || y >= lens.size[1] as i64 {
                continue;
            }
            let there = [x as usize, y as usize];
            let depth = f64::from(self.depths.depth(there[1] * lens.size[0] + there[0]));
            if !depth.is_finite() || met.body.is_some() && self.body_at(there, lens) == met.body {
                continue;
            }
            let other = lens.at(there, depth);
            let away: [f32; 3] = std::array::from_fn(|k| (other[k] - point[k]) as f32);
            let length = away.iter().map(|a| a * a).sum::<f32>().sqrt().max(1e-9);
            let above = (0..3).map(|k| met.normal[k] * away[k]).sum::<f32>() / length;
            let fade = (1.0 - length / (1.5 * world)).max(0.0);
            covered += (above - 0.08).max(0.0) * fade;
        }
        (1.0 - 2.4 * covered / SPIRAL.len() as f32).clamp(0.15, 1.0)
    }

    /// Whether a sample sees a grain.
    fn is_grain(&self, sample: usize) -> bool {
        // Beside the spheres, there are only the faces of clumps.
        let is_grain = |n: usize| n >= self.spheres.len() || self.spheres.role(n) == Role::Grains;
        self.depths.number(sample).is_some_and(is_grain)
    }

    /// The body that a sample sees.
    fn body_at(&self, at: [usize; 2], lens: &Lens) -> Option<u32> {
        self.joined.of(self.depths.number(at[1] * lens.size[0] + at[0])?)
    }
}

/// Adds the bodies of a layer, whose spheres are numbered from `first`; their numbers.
fn join_bodies(joined: &mut JoinedBodies, layer: &PaintedLayer, first: usize, lens: &Lens) -> Vec<u32> {
    let mut smooth = vec![true; layer.bodies.len()];
    layer.solids.iter().for_each(|(n, _)| smooth[*n] = false);
    let seen = |&row: &u32| (lens.seen(layer.spheres.at(row as usize)), layer.spheres.radius(row as usize));
    let body = |(rows, smooth): (&Vec<u32>, bool)| {
        let numbers: Vec<usize> = rows.iter().map(|&row| first + row as usize).collect();
        joined.add(&numbers, if smooth { rows.iter().map(seen).collect() } else { Vec::new() })
    };
    layer.bodies.iter().zip(smooth).map(body).collect()
}

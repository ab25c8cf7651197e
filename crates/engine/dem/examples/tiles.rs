//! Settled piles of any size for benchmarks, out of one: `tiles PILE.ply COUNT OUT.ply|OUT.csv [HEIGHT]`.
//!
//! The bench pile is periodic in x and y, so that copies side by side are a settled pile again: whole copies are taken for `COUNT`
//! above its own. Below, a cube that is cut out of its lower part and stands between walls: grains that lie wholly inside.
//! With HEIGHT [m], only grains below it are taken: a thin bed.
//! Rows are copied as they are (id, x, y, z, radius, velocity, spin; 56 bytes), but for id and place. Prints the number of
//! grains, the extent in x and y [m], whether these are periodic, and pairs a grain that touch and that are less than 0.6 mm apart.

use geom::{Grid, Vec3};
use std::error::Error;
use std::io::{BufWriter, Write};

/// Side of the bench pile [m].
const SIDE: f64 = 0.1196;
/// Bytes of a row.
const ROW: usize = 56;
/// Range of the lists of the other engines [m].
const SKIN: f64 = 0.0006;
/// Spheres of a body in the cost table.
const SPHERES: usize = 4;
/// Share of space that the grains fill.
const FILLED: f64 = 0.6;

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let ([pile, count, out] | [pile, count, out, _]) = &args[..] else {
        return Err("usage: tiles PILE.ply COUNT OUT.ply [HEIGHT]".into());
    };
    let (bytes, count) = (std::fs::read(pile)?, count.parse::<usize>()?);
    let all = Grains::read(&bytes)?;
    let height = args.get(3).map_or(Ok(f64::INFINITY), |h| h.parse())?;
    let low: Vec<_> = all.rows.iter().filter(|r| number(r, 20) + radius(r) < height).copied().collect();
    let grains = Grains { rows: &low, ..all };
    let whole = count >= grains.rows.len();
    let (chosen, extent) = if whole { grains.side_by_side(count) } else { grains.cube(count) };
    let to = BufWriter::new(std::fs::File::create(out)?);
    if out.ends_with(".csv") {
        write_bodies(to, &chosen)?
    } else {
        grains.write(to, &chosen)?
    }
    let pairs = |gap| match whole {
        true => grains.pairs(grains.rows, gap, Some(SIDE)),
        false => grains.pairs(&chosen.iter().map(|c| *c.0).collect::<Vec<_>>(), gap, None),
    };
    let [x, y] = extent;
    println!(
        "{} {x} {y} {} {:.3} {:.3}",
        chosen.len(),
        if whole { "periodic" } else { "walls" },
        pairs(0.0),
        pairs(SKIN)
    );
    Ok(())
}

/// A clump instead of each grain, as text: `scale` 1 stands for a grain of 2 mm radius.
fn write_bodies(mut to: impl Write, chosen: &[Shifted]) -> std::io::Result<()> {
    writeln!(to, "id,x,y,z,scale,vx,vy,vz")?;
    // Spheres of a body have the ids behind its own.
    for (id, (row, shift)) in (0..).step_by(SPHERES).zip(chosen) {
        let [x, y, z] = [0, 1, 2].map(|a| number(row, 4 + 8 * a) + shift[a]);
        let [u, v, w] = [0, 1, 2].map(|a| single(row, 32 + 4 * a));
        writeln!(to, "{id},{x},{y},{z},{},{u},{v},{w}", radius(row) / 0.002)?;
    }
    to.flush()
}

/// The pile's file.
struct Grains<'a> {
    head: String,
    count_line: String,
    rows: &'a [[u8; ROW]],
}

/// A row and how far it is shifted [m].
type Shifted<'a> = (&'a [u8; ROW], [f64; 3]);

impl<'a> Grains<'a> {
    fn read(bytes: &'a [u8]) -> Result<Grains<'a>, Box<dyn Error>> {
        const END: &[u8] = b"end_header\n";
        let end =
            bytes.windows(END.len()).position(|w| w == END).ok_or("no end_header: not a PLY")? + END.len();
        let head = String::from_utf8_lossy(&bytes[..end]).into_owned();
        let line = head.lines().find(|l| l.starts_with("element vertex")).ok_or("no vertices")?.to_owned();
        let (rows, rest) = bytes[end..].as_chunks();
        if line != format!("element vertex {}", rows.len()) || !rest.is_empty() {
            return Err("rows are not those of the bench pile: id, x, y, z, radius, velocity, spin".into());
        }
        Ok(Grains { head, count_line: line, rows })
    }

    fn write(&self, mut to: impl Write, chosen: &[Shifted]) -> std::io::Result<()> {
        let count = format!("element vertex {}", chosen.len());
        to.write_all(self.head.replace(&self.count_line, &count).as_bytes())?;
        for (id, (row, shift)) in (0u32..).zip(chosen) {
            let mut row: [u8; ROW] = **row;
            row[..4].copy_from_slice(&id.to_le_bytes());
            for (axis, shift) in shift.iter().enumerate() {
                let at = 4 + 8 * axis;
                let place = number(&row, at) + shift;
                row[at..at + 8].copy_from_slice(&place.to_le_bytes());
            }
            to.write_all(&row)?;
        }
        to.flush()
    }

    /// Copies in x and y, as square as whole copies allow.
    fn side_by_side(&self, count: usize) -> (Vec<Shifted<'a>>, [f64; 2]) {
        let copies = count.div_ceil(self.rows.len());
        let across = (1..=copies).filter(|n| copies.is_multiple_of(*n) && n * n <= copies).max().unwrap_or(1);
        let along = copies / across;
        let shift = |n: usize| SIDE * n as f64;
        let places = (0..copies).map(|c| [shift(c % along), shift(c / along), 0.0]);
        (places.flat_map(|s| self.rows.iter().map(move |r| (r, s))).collect(), [shift(along), shift(across)])
    }

    /// Grains wholly inside a cube on the floor, in the middle of the pile.
    fn cube(&self, count: usize) -> (Vec<Shifted<'a>>, [f64; 2]) {
        let volume = |r: &[u8; ROW]| 4.0 / 3.0 * std::f64::consts::PI * radius(r).powi(3);
        let mean = self.rows.iter().map(volume).sum::<f64>() / self.rows.len() as f64;
        // Grains that the faces cut are left out: a radius more on each side makes up for them.
        let edge = (count as f64 * mean / FILLED).cbrt() + 0.004;
        let low = 0.5 * (SIDE - edge);
        let inside = |r: &&[u8; ROW]| {
            let across = |x: f64| x - radius(r) > low && x + radius(r) < low + edge;
            across(number(r, 4)) && across(number(r, 12)) && number(r, 20) + radius(r) < edge
        };
        (self.rows.iter().filter(inside).map(|r| (r, [-low, -low, 0.0])).collect(), [edge, edge])
    }

    /// Pairs a grain whose surfaces are less than `gap` [m] apart, also across faces `period` [m] apart.
    fn pairs(&self, rows: &[[u8; ROW]], gap: f64, period: Option<f64>) -> f64 {
        let place = |r: &[u8; ROW]| Vec3::new(number(r, 4), number(r, 12), number(r, 20));
        let largest = rows.iter().map(radius).fold(0.0, f64::max);
        let mut all: Vec<(Vec3, f64)> = rows.iter().map(|r| (place(r), radius(r))).collect();
        let reach = 2.0 * largest + gap;
        for axis in 0..2 {
            let Some(period) = period else { break };
            for k in 0..all.len() {
                let (mut p, r) = all[k];
                if p[axis] < reach {
                    p[axis] += period;
                    all.push((p, r));
                }
            }
        }
        let places: Vec<Vec3> = all.iter().map(|a| a.0).collect();
        let grid = Grid::new(&places, reach);
        let close = |i: usize, j: usize| (all[i].0 - all[j].0).norm() < all[i].1 + all[j].1 + gap;
        let mut found = 0;
        for i in 0..all.len() {
            // A pair of two images is counted where it is no image.
            let partners = grid.within(&places, places[i], reach).map(|j| j as usize);
            found += partners.filter(|&j| i < j && i < rows.len() && close(i, j)).count();
        }
        found as f64 / rows.len() as f64
    }
}

fn number(row: &[u8; ROW], at: usize) -> f64 {
    f64::from_le_bytes(std::array::from_fn(|k| row[at + k]))
}

fn radius(row: &[u8; ROW]) -> f64 {
    single(row, 28)
}

fn single(row: &[u8; ROW], at: usize) -> f64 {
    f64::from(f32::from_le_bytes(std::array::from_fn(|k| row[at + k])))
}

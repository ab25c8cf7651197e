//! A burden over the distance from an axis: height of its surface, mass and thickness of each material, in rings and sectors.
//!
//! The surface is that of the heap angle (see [`crate::repose`]); the height of a ring is the median over it. A grain counts where its centre is. The thickness
//! of a material is the volume of its grains over the area of the ring: what it would be without voids.

use super::sector::sector;
use crate::definition::{ArgumentKind, AskError, Asked, Bins, Frames, Measure};
use crate::observer::{Observer, OfFrame, PerFrame};
use crate::repose::{Frame3, HeapSurface};
use crate::sheet::{Chart, Curve, Head, Look, Row, Summary};
use crate::statistics::median;
use crate::{Frame, MeasureError, Run};
use geom::{Plane, Vec3};
use std::f64::consts::PI;

/// Columns before those of materials.
const FIXED: usize = 7;

/// How a burden is divided.
#[derive(Debug, Clone, PartialEq)]
pub struct RadialOptions {
    /// A point of the axis, and up along it.
    pub axis: Plane,
    pub rings: usize,
    /// Number of sectors, the first from the x axis on.
    pub sectors: usize,
    /// Radius of the outermost ring [m]; `None`: that of the farthest centre in the first frame.
    pub outer: Option<f64>,
    /// Height of the ground [m]; `None`: that of the lowest grains.
    pub ground: Option<f64>,
}

/// What lies in one part of a ring.
#[derive(Debug, Clone, Default)]
struct Part {
    heights: Vec<f64>,
    grains: u64,
    /// Mass [kg] and volume [m³] by material.
    mass: Vec<f64>,
    volume: Vec<f64>,
}

/// Measures a burden in chosen frames.
pub struct Radial {
    options: RadialOptions,
    materials: Vec<String>,
    outer: f64,
    /// Grains beyond the outermost ring in the last frame, and all.
    beyond: [usize; 2],
    last: Vec<Row>,
}

impl Radial {
    /// With these options.
    ///
    /// # Errors
    /// No ring or sector, or a radius not above zero.
    pub fn new(options: RadialOptions) -> Result<Radial, MeasureError> {
        for (what, count) in [("bins", options.rings), ("sectors", options.sectors)] {
            if count == 0 {
                return Err(MeasureError::Setting { what, value: 0.0, unit: "", cure: "give at least one" });
            }
        }
        if let Some(value) = options.outer.filter(|r| !(*r > 0.0 && r.is_finite())) {
            return Err(MeasureError::Setting {
                what: "outer",
                value,
                unit: "m",
                cure: "give a radius above 0",
            });
        }
        let outer = options.outer.unwrap_or(0.0);
        Ok(Radial { options, materials: Vec::new(), outer, beyond: [0; 2], last: Vec::new() })
    }

    /// Number of the part in which a point lies, from its coordinates across the axis; `None` beyond the outermost ring.
    fn part(&self, [a, b]: [f64; 2]) -> Option<usize> {
        let RadialOptions { rings, sectors, .. } = self.options;
        let ring = (a.hypot(b) / self.outer * rings as f64) as usize;
        (ring < rings).then(|| sector([a, b], sectors) * rings + ring)
    }
}

impl OfFrame for Radial {
    fn heads(&self) -> Vec<Head> {
        let mut heads = Head::list(&[
            ("time", "s"),
            ("sector", "1"),
            ("inner", "m"),
            ("outer", "m"),
            ("height", "m"),
            ("grains", "1"),
            ("mass", "kg"),
        ]);
        for name in &self.materials {
            for (what, unit) in [("mass", "kg"), ("thickness", "m"), ("share", "1")] {
                heads.push(Head { name: format!("{what}_{name}"), unit });
            }
        }
        heads
    }

    fn measure(&mut self, run: &Run, frame: &Frame) -> Result<Vec<Row>, MeasureError> {
        if frame.is_empty() {
            return Err(MeasureError::NoGrains { time: frame.time });
        }
        let RadialOptions { axis, rings, sectors, ground, .. } = self.options;
        let axes = Frame3::new(axis.normal);
        let across = |at: &Vec3| [axes.u, axes.v].map(|side| (at - axis.point).dot(&side));
        if self.materials.is_empty() {
            // Walls have materials, too: those that grains are of.
            let named = |m: u16| run.materials.get(usize::from(m)).cloned().unwrap_or_else(|| m.to_string());
            let most = frame.material.iter().copied().max().unwrap_or(0);
            let counted = run.materials.len().max(usize::from(most) + 1);
            self.materials = (0..counted as u16).map(named).collect();
        }
        if self.outer == 0.0 {
            let far = frame.position.iter().map(across).map(|[a, b]| a.hypot(b)).fold(0.0, f64::max);
            self.outer = far.max(frame.mean_diameter()) * (1.0 + 1e-12);
        }
        let mut parts = vec![Part::default(); rings * sectors];
        for part in &mut parts {
            (part.mass, part.volume) = (vec![0.0; self.materials.len()], vec![0.0; self.materials.len()]);
        }
        let mut beyond = 0;
        let masses = frame.masses()?;
        for (k, at) in frame.position.iter().enumerate() {
            let Some(part) = self.part(across(at)) else {
                beyond += 1;
                continue;
            };
            let (part, material) = (&mut parts[part], usize::from(frame.material[k]));
            part.grains += 1;
            part.mass[material] += masses[k];
            part.volume[material] += masses[k] / run.densities.get(material).copied().unwrap_or(f64::NAN);
        }
        self.beyond = [beyond, frame.len()];
        let surface = HeapSurface::new(frame, &axes, ground);
        let middle = [axes.u, axes.v].map(|side| axis.point.dot(&side));
        for [u, v, height] in &surface.points {
            if let Some(part) = self.part([u - middle[0], v - middle[1]]) {
                parts[part].heights.push(height - surface.ground);
            }
        }
        let width = self.outer / rings as f64;
        let row = |(n, part): (usize, &mut Part)| {
            let (sector, ring) = (n / rings, (n % rings) as f64);
            let [inner, outer] = [ring * width, (ring + 1.0) * width];
            let area = PI * (outer * outer - inner * inner) / sectors as f64;
            let height = if part.heights.is_empty() { f64::NAN } else { median(&mut part.heights) };
            let mass: f64 = part.mass.iter().sum();
            let mut row =
                vec![frame.time, (sector + 1) as f64, inner, outer, height, part.grains as f64, mass];
            for (of, volume) in part.mass.iter().zip(&part.volume) {
                row.extend([*of, volume / area, if mass > 0.0 { of / mass } else { f64::NAN }]);
            }
            row
        };
        self.last = parts.iter_mut().enumerate().map(row).collect();
        Ok(self.last.clone())
    }

    fn end(&mut self) -> Result<(Vec<Row>, Summary), MeasureError> {
        let time = self.last.first().map_or(f64::NAN, |row| row[0]);
        let sum = |column: usize| self.last.iter().map(|row| row[column]).sum::<f64>();
        let summary = Summary::default().with("mass", "kg", sum(6)).with("time", "s", time);
        Ok((
            Vec::new(),
            match self.beyond {
                [0, _] => summary,
                [beyond, of] => summary.note(format!(
                    "{beyond} of {of} grains lie beyond {} m from the axis: --outer takes them in",
                    geom::Shown(self.outer)
                )),
            },
        ))
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        let last = rows.last().map_or(f64::NAN, |row| row[0]);
        let of = |column: usize, name: &str, sector: f64| Curve {
            name: name.to_owned(),
            points: rows
                .iter()
                .filter(|row| row[0] == last && row[1] == sector && row[column].is_finite())
                .map(|row| [0.5 * (row[2] + row[3]), row[column]])
                .collect(),
            look: Look::Line,
        };
        let sectors = || (1..=self.options.sectors).map(|s| s as f64);
        let named = |s: f64| if self.options.sectors > 1 { format!("sector {s}") } else { String::new() };
        let heights = sectors().map(|s| of(4, &named(s), s)).collect();
        let thicknesses =
            self.materials.iter().enumerate().flat_map(|(m, material)| {
                sectors().map(move |s| (m, material.clone(), s)).collect::<Vec<_>>()
            });
        let thicknesses = thicknesses.map(|(m, material, s)| {
            let name = format!("{material} {}", named(s)).trim().to_owned();
            of(FIXED + 3 * m + 1, &name, s)
        });
        let present = |curve: &Curve| curve.points.iter().any(|p| p[1] > 0.0);
        Chart::new("Burden over the distance from the axis")
            .curves("distance from the axis [m]", "height [m]", heights)
            .curves(
                "distance from the axis [m]",
                "thickness without voids [m]",
                thicknesses.filter(present).collect(),
            )
    }
}

impl Measure for Radial {
    const NAME: &'static str = "radial";
    const HELP: &'static str = "A burden around AXIS (px,py,pz and up along it): height, mass and thickness of each material, in rings";
    const ARGUMENT: ArgumentKind = ArgumentKind::Axis;
    const FRAMES: Frames = Frames::Last;
    const OPTIONS: &'static [&'static str] = &["sectors", "outer", "ground", "bins"];

    fn observer(asked: &Asked) -> Result<Box<dyn Observer>, AskError> {
        let rings = match asked.bins.unwrap_or(Bins::One(20)) {
            Bins::One(rings) => rings,
            Bins::All(_) => {
                return Err(AskError::Usage("--bins: --radial has rings only: give one number".to_owned()));
            }
        };
        let (axis, sectors) = (asked.plane()?, asked.sectors.unwrap_or(1));
        let options = RadialOptions { axis, rings, sectors, outer: asked.outer, ground: asked.ground };
        Ok(Box::new(PerFrame::new(Radial::new(options)?).without_fallen()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cone of 30° of two materials, one inside of half of its radius: heights fall by the slope, thicknesses are volumes over areas.
    #[test]
    fn a_cone_of_two_materials_is_found_again() {
        let (r, outer) = (0.005, 0.2);
        let slope = 30f64.to_radians().tan();
        let mut frame = Frame { time: 2.0, ..Frame::default() };
        for k in 0..90 * 90 {
            let at = Vec3::new(0.0045 * f64::from(k % 90) - 0.2, 0.0045 * f64::from(k / 90) - 0.2, 0.0);
            let far = at.x.hypot(at.y);
            if far < outer {
                frame.id.push(k as u64);
                frame.position.push(at + Vec3::new(1.0, 2.0, 0.5 + slope * (outer - far)));
                frame.radius.push(r);
                frame.material.push(u16::from(far > outer / 2.0));
                frame.mass.push(if far > outer / 2.0 { 3.0 } else { 1.0 });
            }
        }
        let run = Run {
            materials: vec!["coke".into(), "ore".into(), "steel".into()],
            densities: vec![1000.0, 3000.0, f64::NAN],
            ..Run::default()
        };
        let axis = Plane { point: Vec3::new(1.0, 2.0, 0.0), normal: Vec3::z() };
        let options = RadialOptions { axis, rings: 10, sectors: 2, outer: Some(outer), ground: Some(0.5) };
        let mut radial = Radial::new(options).unwrap();
        let rows = radial.measure(&run, &frame).unwrap();
        assert_eq!((rows.len(), radial.heads().len(), rows[0].len()), (20, FIXED + 9, FIXED + 9));
        for row in &rows {
            let middle = 0.5 * (row[2] + row[3]);
            let right = slope * (outer - middle) + r;
            assert!((row[4] - right).abs() < 0.004, "{middle}: {} and not {right}", row[4]);
            let (ore, share) = (row[2] >= outer / 2.0 - 1e-9, [FIXED + 2, FIXED + 5].map(|c| row[c]));
            assert_eq!(share, if ore { [0.0, 1.0] } else { [1.0, 0.0] });
            let area = PI * (row[3] * row[3] - row[2] * row[2]) / 2.0;
            let thickness = row[FIXED + if ore { 4 } else { 1 }];
            assert!((thickness * area - row[5] * 1e-3).abs() < 1e-12 * row[5], "{thickness}");
        }
        let total: f64 = rows.iter().map(|row| row[6]).sum();
        assert!((total - frame.mass.iter().sum::<f64>()).abs() < 1e-9);
        // Beyond a smaller ring grains are left out, which is said.
        let small = RadialOptions { outer: Some(0.1), ..radial.options.clone() };
        let mut small = Radial::new(small).unwrap();
        small.measure(&run, &frame).unwrap();
        assert!(small.end().unwrap().1.notes[0].contains("--outer"));
        assert!(Radial::new(RadialOptions { rings: 0, ..radial.options.clone() }).is_err());
    }
}

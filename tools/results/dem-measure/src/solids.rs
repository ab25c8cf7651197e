//! What was measured as triangles and spheres in space, for ParaView (`.vtp`) and for CloudCompare (`.ply`).

use crate::args::Args;
use crate::sheet::Sheet;
use anyhow::{Context, anyhow};
use cli::usage;
use measure::{Geometry, Observer};
use stream::Values;
use view::vtk::{Field, PolyData};

/// How what is measured is written.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Solids {
    /// As rows.
    None,
    Vtp,
    Ply,
}

impl Solids {
    /// By the ending of the output's name.
    ///
    /// # Errors
    /// A geometry of a measure that has none, or in a format of rows.
    pub fn of(args: &Args) -> anyhow::Result<Solids> {
        let kind = match &args.output {
            output if output.has_extension("vtp") => Solids::Vtp,
            output if output.has_extension("ply") => Solids::Ply,
            _ => return Ok(Solids::None),
        };
        let (name, measure) = (args.output.name(), args.measure.entry.name);
        if measure != "wear" {
            return Err(usage(format!(
                "-o {name}: only --wear is a geometry: name the output of --{measure} .csv"
            )));
        }
        if args.json {
            return Err(usage(format!("--json: {name} is no JSON: leave it out, or name the output .json")));
        }
        Ok(kind)
    }

    /// Where rows go: nowhere where a geometry is written.
    pub fn sheet(self, args: &Args, what: &str) -> anyhow::Result<Option<Sheet>> {
        Ok(match self {
            Solids::None => Some(Sheet::new(args.output.open_text()?, args.json, what)),
            Solids::Vtp | Solids::Ply => None,
        })
    }

    /// Writes the geometry.
    pub fn write(self, args: &Args, measure: &dyn Observer) -> anyhow::Result<()> {
        let name = args.output.name();
        let geometry = measure.geometry().map_err(|why| anyhow!("-o {name}: {why}"))?;
        let data = points(&geometry);
        let mut out = args.output.open()?;
        let remarks: Vec<String> =
            geometry.heads.iter().map(|head| format!("{} [{}]", head.name, head.unit)).collect();
        let written = match self {
            Solids::Ply => data.write_ply(&remarks, &mut out),
            _ => data.write(&mut out),
        };
        written.with_context(|| format!("{name}: cannot write"))?;
        out.commit()
    }
}

/// Centres of spheres, then the corners of triangles: triangles do not share corners, so that the three of each carry its numbers.
fn points(geometry: &Geometry) -> PolyData {
    let Geometry { heads, triangles, spheres } = geometry;
    let mut points = Vec::with_capacity(3 * (spheres.len() + 3 * triangles.len()));
    for (centre, _, _) in spheres {
        points.extend([centre.x, centre.y, centre.z]);
    }
    for corner in triangles.iter().flat_map(|(corners, _)| corners) {
        points.extend([corner.x, corner.y, corner.z]);
    }
    let column = |of_sphere: &dyn Fn(usize) -> f64, of_triangle: &dyn Fn(usize) -> f64| {
        let corners = (0..triangles.len()).flat_map(|k| [of_triangle(k); 3]);
        // What never wears lasts for ever, which no scale of colours has.
        let known = |value: f64| if value.is_finite() { value } else { f64::NAN };
        (0..spheres.len()).map(of_sphere).chain(corners).map(known).collect::<Vec<f64>>()
    };
    let field = |name: &str, values| Field { name: name.to_owned(), components: 1, values };
    let radii = || field("radius", Values::F64(column(&|k| spheres[k].1, &|_| f64::NAN)));
    let mut fields: Vec<Field> = (!spheres.is_empty()).then(radii).into_iter().collect();
    for (k, head) in heads.iter().enumerate() {
        let values = column(&|row| spheres[row].2[k], &|row| triangles[row].1[k]);
        let whole = ["wall", "part", "impacts"].contains(&head.name.as_str());
        // Impacts from contacts alone are not known.
        let values = match whole && values.iter().all(|v| v.is_finite()) {
            true => Values::U32(values.into_iter().map(|v| v as u32).collect()),
            false => Values::F64(values),
        };
        fields.push(field(&head.name, values));
    }
    let first = spheres.len() as u32;
    let faces = (0..triangles.len() as u32).map(|k| [0, 1, 2].map(|corner| first + 3 * k + corner));
    PolyData { time: None, points, single: false, fields, alone: spheres.len(), faces: faces.collect() }
}

//! VTK's XML format for points and triangles (`.vtp`), as ParaView reads it.
//!
//! The head is XML; the numbers follow it as raw little-endian bytes, each block behind its length (`UInt64`):
//! "appended raw" of the VTK file formats guide (Kitware, VTK User's Guide, 11th ed., 19.3).

use std::io::{self, Write};
use stream::Values;

/// Points with fields, some drawn as they are, some as corners of triangles.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PolyData {
    /// Shown as the time of the data [s].
    pub time: Option<f64>,
    /// x y z of each point [m].
    pub points: Vec<f64>,
    /// Whether the places came as single precision, and so are written.
    pub single: bool,
    /// Values at the points.
    pub fields: Vec<Field>,
    /// The first so many points are vertices of their own.
    pub alone: usize,
    /// Three points each.
    pub faces: Vec<[u32; 3]>,
}

/// Values at the points.
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    /// As ParaView shows it.
    pub name: String,
    /// Numbers a point: 3 for a vector.
    pub components: usize,
    /// Point by point.
    pub values: Values,
}

/// A block of numbers behind the head.
struct Block {
    name: String,
    kind: &'static str,
    components: usize,
    bytes: Vec<u8>,
}

impl PolyData {
    /// How many points there are.
    pub fn len(&self) -> usize {
        self.points.len() / 3
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Writes the file.
    ///
    /// # Errors
    /// A write that fails.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let fields = self.fields.iter().map(|f| block(&f.name, f.components, &f.values)).collect();
        let points = vec![self.places()];
        let verts = cells((0..self.alone as i32).collect(), 1);
        let corners = self.faces.iter().flatten().map(|&c| c as i32);
        let polys = cells(corners.collect(), 3);
        let groups = [("PointData", fields), ("Points", points), ("Verts", verts), ("Polys", polys)];
        writeln!(out, "<?xml version=\"1.0\"?>")?;
        writeln!(
            out,
            "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">"
        )?;
        writeln!(out, "<PolyData>")?;
        if let Some(time) = self.time {
            writeln!(
                out,
                "<FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{time}\
                 </DataArray></FieldData>"
            )?;
        }
        writeln!(
            out,
            "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"{}\">",
            self.len(),
            self.alone,
            self.faces.len()
        )?;
        head(out, &groups)?;
        writeln!(out, "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">")?;
        write!(out, "_")?;
        for block in groups.iter().flat_map(|(_, blocks)| blocks) {
            out.write_all(&(block.bytes.len() as u64).to_le_bytes())?;
            out.write_all(&block.bytes)?;
        }
        writeln!(out, "\n</AppendedData>\n</VTKFile>")
    }

    fn places(&self) -> Block {
        let values = if self.single {
            Values::F32(self.points.iter().map(|&c| c as f32).collect())
        } else {
            Values::F64(self.points.clone())
        };
        block("Points", 3, &values)
    }
}

/// Which points each cell has, and where the list of each cell ends.
fn cells(points: Vec<i32>, each: usize) -> Vec<Block> {
    let ends = (1..=points.len() / each).map(|n| (n * each) as i32).collect();
    vec![block("connectivity", 1, &Values::I32(points)), block("offsets", 1, &Values::I32(ends))]
}

/// What stands before the numbers: name, type, and offset of each block.
fn head(out: &mut impl Write, groups: &[(&str, Vec<Block>)]) -> io::Result<()> {
    let mut offset = 0;
    for (group, blocks) in groups {
        writeln!(out, "<{group}>")?;
        for Block { name, kind, components, bytes } in blocks {
            writeln!(
                out,
                "<DataArray type=\"{kind}\" Name=\"{}\" NumberOfComponents=\"{components}\" format=\"appended\" \
                 offset=\"{offset}\"/>",
                escaped(name)
            )?;
            offset += 8 + bytes.len();
        }
        writeln!(out, "</{group}>")?;
    }
    Ok(())
}

fn block(name: &str, components: usize, values: &Values) -> Block {
    macro_rules! raw {
        ($($variant:ident $kind:literal),*) => {
            match values {
                $(Values::$variant(v) => ($kind, v.iter().flat_map(|n| n.to_le_bytes()).collect()),)*
            }
        };
    }
    let (kind, bytes) = raw!(I8 "Int8", U8 "UInt8", I16 "Int16", U16 "UInt16", I32 "Int32", U32 "UInt32",
        F32 "Float32", F64 "Float64");
    Block { name: name.to_owned(), kind, components, bytes }
}

/// Text as an attribute of XML.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

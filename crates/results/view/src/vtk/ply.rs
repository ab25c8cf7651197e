//! The same as binary PLY, whose properties CloudCompare reads as scalar fields.

use super::polydata::PolyData;
use std::io::{self, Write};
use stream::Values;

impl PolyData {
    /// Writes a PLY file: points with their fields as properties, then the triangles. Vectors are left out; `remarks` are comments at its head.
    ///
    /// # Errors
    /// A write that fails.
    pub fn write_ply(&self, remarks: &[String], out: &mut impl Write) -> io::Result<()> {
        let fields: Vec<_> = self.fields.iter().filter(|field| field.components == 1).collect();
        writeln!(out, "ply\nformat binary_little_endian 1.0")?;
        for remark in remarks {
            writeln!(out, "comment {}", remark.replace(['\n', '\r'], " "))?;
        }
        writeln!(out, "element vertex {}", self.len())?;
        ["x", "y", "z"].iter().try_for_each(|axis| writeln!(out, "property double {axis}"))?;
        for field in &fields {
            writeln!(out, "property {} {}", kind(&field.values), field.name.replace(' ', "_"))?;
        }
        writeln!(
            out,
            "element face {}\nproperty list uchar int vertex_indices\nend_header",
            self.faces.len()
        )?;
        for (row, place) in self.points.chunks_exact(3).enumerate() {
            place.iter().try_for_each(|c| out.write_all(&c.to_le_bytes()))?;
            fields.iter().try_for_each(|field| number(&field.values, row, out))?;
        }
        for face in &self.faces {
            out.write_all(&[3])?;
            face.iter().try_for_each(|corner| out.write_all(&(*corner as i32).to_le_bytes()))?;
        }
        Ok(())
    }
}

/// The type of a property.
fn kind(values: &Values) -> &'static str {
    match values {
        Values::I8(_) => "char",
        Values::U8(_) => "uchar",
        Values::I16(_) => "short",
        Values::U16(_) => "ushort",
        Values::I32(_) => "int",
        Values::U32(_) => "uint",
        Values::F32(_) => "float",
        Values::F64(_) => "double",
    }
}

fn number(values: &Values, row: usize, out: &mut impl Write) -> io::Result<()> {
    macro_rules! raw {
        ($($variant:ident),*) => {
            match values {
                $(Values::$variant(v) => out.write_all(&v[row].to_le_bytes()),)*
            }
        };
    }
    raw!(I8, U8, I16, U16, I32, U32, F32, F64)
}

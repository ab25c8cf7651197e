//! STL, ASCII and binary (many binary files begin with the word "solid" too).
//!
//! ```text
//! binary   80 bytes, count, count × (normal, 3 corners: 12 numbers of 4 bytes; 2 bytes)      little endian; another file may follow, and less than a triangle is passed over
//! ASCII    solid NAME, facets, endsolid NAME; any number of solids                           one mesh; numbers in double precision
//! ```
//!
//! A file whose length is what its count promises is binary, whatever it begins with. Normals are not read: many programs write none, or wrong ones. Corners at
//! equal places are one vertex. 3D Systems (1989), Stereolithography Interface Specification.

use crate::contents::lines;
use crate::{Contents, MeshFileError};
use geom::{Vec3, mesh::TriMesh};
use std::collections::HashMap;

/// Bytes before the first triangle of a binary file, and of each triangle.
const HEAD: usize = 84;
const TRIANGLE: usize = 50;
/// The mark of UTF-8 that some programs write first.
const BYTE_ORDER_MARK: &[u8] = b"\xEF\xBB\xBF";

pub(crate) fn matches(bytes: &[u8]) -> bool {
    is_ascii(bytes) || promised(bytes).is_some_and(|n| is_whole(bytes, n) || begins_with_a_triangle(bytes))
}

/// Whether a head with room for text is followed by a triangle: finite corners, and a normal of length 1 or 0.
fn begins_with_a_triangle(bytes: &[u8]) -> bool {
    let Some(triangle) = bytes.get(HEAD..HEAD + TRIANGLE) else { return bytes[..HEAD].contains(&0) };
    let numbers = numbers(triangle);
    let normal = numbers[..3].iter().map(|n| n * n).sum::<f64>().sqrt();
    let plain = |n: &f64| *n == 0.0 || (1e-12..1e9).contains(&n.abs());
    bytes[..HEAD].contains(&0)
        && numbers.iter().any(|n| *n != 0.0)
        && numbers.iter().all(plain)
        && (normal < 1e-6 || (0.9..1.1).contains(&normal))
}

/// The normal and the corners of a binary triangle.
fn numbers(triangle: &[u8]) -> Vec<f64> {
    let (numbers, _) = triangle.as_chunks::<4>();
    numbers.iter().take(12).map(|b| f64::from(f32::from_le_bytes(*b))).collect()
}

/// The word, and a facet or the end of the solid after it, however long the name is; a binary file may begin with these, too, and is known by its length.
fn is_ascii(bytes: &[u8]) -> bool {
    if promised(bytes).is_some_and(|n| n > 0 && is_whole(bytes, n)) {
        return false;
    }
    let text = bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes).trim_ascii_start();
    let begins = text.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    let holds = |word: &[u8]| text.windows(word.len()).any(|part| part.eq_ignore_ascii_case(word));
    begins && (holds(b"facet") || holds(b"endsolid"))
}

/// Triangles that the head of a binary file promises.
fn promised(bytes: &[u8]) -> Option<u64> {
    let count = bytes.get(HEAD - 4..HEAD)?;
    Some(count.iter().rev().fold(0, |sum, &b| sum << 8 | u64::from(b)))
}

fn is_whole(bytes: &[u8], promised: u64) -> bool {
    (bytes.len() - HEAD) as u64 == promised * TRIANGLE as u64
}

pub(crate) fn read(bytes: &[u8]) -> Result<Contents, MeshFileError> {
    let mut solid = Solid::default();
    let short = !is_ascii(bytes);
    if short {
        solid.read_binary(bytes)?
    } else {
        solid.read_text(bytes)?
    }
    Ok(Contents { short, ..TriMesh::new(solid.vertices, solid.faces)?.into() })
}

/// What has been read.
#[derive(Default)]
struct Solid {
    vertices: Vec<Vec3>,
    faces: Vec<[u32; 3]>,
    /// The vertex at a place, by the bits of its coordinates.
    known: HashMap<[u64; 3], u32>,
}

impl Solid {
    /// The vertex at this place.
    fn vertex(&mut self, place: Vec3) -> u32 {
        // −0 and 0 are one place.
        let bits = [0, 1, 2].map(|a| (place[a] + 0.0).to_bits());
        let next = self.vertices.len() as u32;
        *self.known.entry(bits).or_insert_with(|| {
            self.vertices.push(place);
            next
        })
    }

    /// Reads one file, and those that were joined to it.
    fn read_binary(&mut self, mut bytes: &[u8]) -> Result<(), MeshFileError> {
        loop {
            let (count, rest) = self.read_one(bytes)?;
            if rest.len() < TRIANGLE {
                return Ok(());
            }
            let is_whole = |next: u64| next > 0 && (rest.len() - HEAD) as u64 / TRIANGLE as u64 >= next;
            if !(promised(rest).is_some_and(is_whole) && begins_with_a_triangle(rest)) {
                return Err(MeshFileError::Stl(format!(
                    "its head promises {count} triangles, and {} bytes follow them, which are no further file: more triangles than it \
                     counts, or something else",
                    rest.len()
                )));
            }
            bytes = rest;
        }
    }

    /// Reads one file; gives its count and what follows it.
    fn read_one<'a>(&mut self, bytes: &'a [u8]) -> Result<(u64, &'a [u8]), MeshFileError> {
        let Some(count) = promised(bytes) else {
            return Err(MeshFileError::Stl(format!(
                "{} bytes are less than the head of a file",
                bytes.len()
            )));
        };
        let body = &bytes[HEAD..];
        let held = (body.len() / TRIANGLE) as u64;
        if held < count || count == 0 && held > 0 {
            return Err(MeshFileError::CutOff { promised: count, held });
        }
        let (body, rest) = body.split_at(count as usize * TRIANGLE);
        for triangle in body.chunks_exact(TRIANGLE) {
            let numbers = numbers(triangle);
            let face = [3, 6, 9].map(|k| Vec3::from_column_slice(&numbers[k..k + 3]));
            let face = face.map(|corner| self.vertex(corner));
            self.faces.push(face);
        }
        Ok((count, rest))
    }

    fn read_text(&mut self, bytes: &[u8]) -> Result<(), MeshFileError> {
        let bytes = bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes);
        let (mut open, mut corners) = (false, None::<Vec<u32>>);
        let mut last = 0;
        for (number, line) in lines(bytes) {
            last = number;
            let wrong = |what: &str| {
                MeshFileError::Stl(format!("line {number}: {what}: '{}'", line.trim().escape_default()))
            };
            let mut words = line.split_whitespace().peekable();
            while let Some(word) = words.next() {
                match word.to_ascii_lowercase().as_str() {
                    // What follows is a name, which may hold any word.
                    "solid" if !open => {
                        open = true;
                        break;
                    }
                    "endsolid" | "end" if open && corners.is_none() => {
                        open = false;
                        break;
                    }
                    "facet" if open && corners.is_none() => {
                        corners = Some(Vec::new());
                        // The normal.
                        while words.next_if(|word| !word.eq_ignore_ascii_case("outer")).is_some() {}
                    }
                    "outer" | "loop" | "endloop" if corners.is_some() => {}
                    "vertex" => {
                        let Some(corners) = &mut corners else {
                            return Err(wrong("a vertex outside a facet"));
                        };
                        let mut next = || words.next().and_then(|x| x.parse::<f64>().ok());
                        let (Some(x), Some(y), Some(z)) = (next(), next(), next()) else {
                            return Err(wrong("a vertex is not three numbers"));
                        };
                        corners.push(self.vertex(Vec3::new(x, y, z)));
                    }
                    "endfacet" => match corners.take().as_deref() {
                        Some(&[a, b, c]) => self.faces.push([a, b, c]),
                        Some(other) => {
                            return Err(wrong(&format!("a facet of {} corners ends", other.len())));
                        }
                        None => return Err(wrong("a facet ends that has not begun")),
                    },
                    // Remarks, and the colours that some programs write.
                    _ if word.starts_with(['#', ';', '!']) || word.starts_with("//") => break,
                    "color" | "colour" => break,
                    _ => return Err(wrong("is no line of STL here")),
                }
            }
        }
        if open || corners.is_some() {
            return Err(MeshFileError::Stl(format!(
                "the line 'endsolid' is missing after line {last}: the file is cut off"
            )));
        }
        Ok(())
    }
}

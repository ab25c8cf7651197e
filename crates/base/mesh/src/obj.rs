//! Wavefront OBJ: the elements `v` and `f`. Points `p` and lines `l` are no surface; normals, textures and materials are ignored.
//!
//! Text may have any encoding: names are not read. A `\` at the end of a line continues it on the next one. A vertex is in the mesh if a face has it, in the order of
//! the faces; a file without faces is its vertices. Wavefront (1995), Advanced Visualizer manual, appendix B1: Object files.

use crate::contents::lines;
use crate::{Contents, MeshFileError, polygon};
use geom::{Vec3, mesh::TriMesh};

/// Lines among which the first vertex stands.
const FIRST_LINES: usize = 200;

pub(crate) fn matches(bytes: &[u8]) -> bool {
    let vertex = |(_, line): (usize, std::borrow::Cow<str>)| {
        let mut words = line.split_whitespace();
        words.next() == Some("v") && words.take(3).filter(|w| w.parse::<f64>().is_ok()).count() == 3
    };
    lines(bytes).take(FIRST_LINES).any(vertex)
}

pub(crate) fn read(bytes: &[u8]) -> Result<Contents, MeshFileError> {
    let (mut obj, mut whole, mut first) = (Obj::default(), String::new(), 0);
    for (number, line) in lines(bytes) {
        let line = line.trim_end();
        let begun = line.strip_suffix('\\');
        if whole.is_empty() {
            first = number;
        }
        if let Some(part) = begun {
            whole.push_str(part);
            whole.push(' ');
        } else if whole.is_empty() {
            obj.line(number, line)?;
        } else {
            whole.push_str(line);
            obj.line(first, &whole)?;
            whole.clear();
        }
    }
    if !whole.is_empty() {
        return Err(wrong(first, "the line that continues it is missing: the file is cut off", &whole));
    }
    obj.contents()
}

fn wrong(line: usize, what: &str, text: &str) -> MeshFileError {
    let text: String = text.trim().chars().take(60).collect();
    MeshFileError::Obj(format!("line {line}: {what}: '{}'", text.escape_default()))
}

/// What has been read.
#[derive(Default)]
struct Obj {
    vertices: Vec<Vec3>,
    /// Vertices of all faces, one after the other, where each face ends among them, and its line.
    corners: Vec<u32>,
    ends: Vec<(usize, usize)>,
    /// Elements `l` and `p`.
    lines: usize,
    points: usize,
    /// Vertices with a colour.
    coloured: usize,
}

/// Which indices a corner of a face has besides that of its vertex.
type Form = (usize, bool, bool);

impl Obj {
    fn line(&mut self, number: usize, line: &str) -> Result<(), MeshFileError> {
        let line = line.split('#').next().unwrap_or_default();
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let mut next = || words.next().and_then(|word| word.parse::<f64>().ok());
                let (Some(x), Some(y), Some(z)) = (next(), next(), next()) else {
                    return Err(wrong(number, "a vertex is not three numbers", line));
                };
                self.vertices.push(Vec3::new(x, y, z));
                self.coloured += usize::from(words.count() >= 3);
            }
            Some("f" | "fo") => {
                let face = self.ends.len() + 1;
                self.face(words).map_err(|what| wrong(number, &format!("face {face}: {what}"), line))?;
                self.ends.push((self.corners.len(), number));
            }
            Some("l") => self.lines += 1,
            Some("p") => self.points += 1,
            _ => {}
        }
        Ok(())
    }

    fn face<'a>(&mut self, words: impl Iterator<Item = &'a str>) -> Result<(), String> {
        let (mut count, mut first) = (0, None);
        for word in words {
            let (index, form) =
                corner(word).ok_or_else(|| format!("'{word}' is not the number of a vertex"))?;
            if *first.get_or_insert(form) != form {
                return Err("its corners have different numbers of indices: it is cut off".to_owned());
            }
            self.corners.push(self.vertex(index)?);
            count += 1;
        }
        match count {
            3.. => Ok(()),
            _ => Err(format!("{count} corners where a face has at least 3: it is cut off")),
        }
    }

    /// The vertex of an index, which counts from 1, or back from the last one if it is negative.
    fn vertex(&self, index: i64) -> Result<u32, String> {
        let from = if index < 0 { (self.vertices.len() as i64).saturating_add(index) } else { index - 1 };
        u32::try_from(from).map_err(|_| format!("there is no vertex {index}"))
    }

    /// All faces as triangles.
    fn triangles(&self) -> Result<Vec<[u32; 3]>, MeshFileError> {
        let (mut triangles, mut start, there) = (Vec::with_capacity(self.ends.len()), 0, self.vertices.len());
        for (face, &(end, line)) in (1..).zip(&self.ends) {
            let corners = &self.corners[start..end];
            start = end;
            let cut = match corners.iter().find(|&&v| v as usize >= there) {
                Some(v) => Err(format!("vertex {} of {there} is not there", u64::from(*v) + 1)),
                None => polygon::cut(corners, &self.vertices, &mut triangles),
            };
            cut.map_err(|what| MeshFileError::Obj(format!("line {line}: face {face}: {what}")))?;
        }
        Ok(triangles)
    }

    fn contents(self) -> Result<Contents, MeshFileError> {
        let mut notes = Vec::new();
        for (count, name) in [(self.lines, "lines (l)"), (self.points, "points (p)")] {
            if count > 0 {
                notes.push(format!("{count} {name} were left out: they are no surface"));
            }
        }
        let mut faces = self.triangles()?;
        // A coordinate that is not finite is refused with its number in the file.
        let all = TriMesh::new(self.vertices, Vec::new())?;
        if faces.is_empty() {
            if self.coloured > 0 {
                notes
                    .push(format!("the colours of {} vertices were left out: PLY keeps them", self.coloured));
            }
            return Ok(Contents { mesh: all, notes, short: false });
        }
        let (all, mut used) = (all.vertices, Vec::new());
        let mut numbers = vec![u32::MAX; all.len()];
        for corner in faces.iter_mut().flatten() {
            let number = &mut numbers[*corner as usize];
            if *number == u32::MAX {
                *number = used.len() as u32;
                used.push(all[*corner as usize]);
            }
            *corner = *number;
        }
        Ok(Contents { mesh: TriMesh::new(used, faces)?, notes, short: false })
    }
}

/// The vertex of a corner `v`, `v/vt`, `v//vn` or `v/vt/vn`, and which of these it is.
fn corner(word: &str) -> Option<(i64, Form)> {
    let mut parts = word.split('/');
    let vertex = parts.next()?.parse().ok()?;
    let (texture, normal) = (parts.next(), parts.next());
    let is_there = |part: Option<&str>| part.is_some_and(|part| !part.is_empty());
    let count = usize::from(texture.is_some()) + usize::from(normal.is_some());
    parts.next().is_none().then(|| (vertex, (count, is_there(texture), is_there(normal))))
}

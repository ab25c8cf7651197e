//! Reads what is to be shown: runs and walls (MCAP), and clouds, told apart by their content.

use crate::run;
use anyhow::Context;
use cli::Source;
use serde_json::{Value, json};
use std::io::{Cursor, Read};
use stream::{Table, Values};
use view::{Motion, Page, Role, Surface, SurfaceShape, ViewError};

/// The bytes that every MCAP stream begins with.
const MCAP: &[u8] = b"\x89MCAP";

/// Whatever shows layers.
pub trait Show {
    /// Adds a layer.
    fn layer(&mut self, role: Role, name: &str) -> usize;
    /// Names the layer's materials.
    fn kinds(&mut self, layer: usize, kinds: Vec<String>);
    /// Lets a layer move as one body; its only state is that at t = 0.
    fn moves(&mut self, layer: usize, motion: Motion);
    /// Adds a wall that is a plane or a mesh.
    fn surface(&mut self, surface: Surface);
    /// Adds a state of a layer.
    fn push(&mut self, layer: usize, time: f64, table: Table) -> Result<(), ViewError>;
    /// Whether only the points of a cloud are wanted.
    fn wants_points(&self) -> bool {
        false
    }
}

impl Show for Page {
    fn layer(&mut self, role: Role, name: &str) -> usize {
        Page::layer(self, role, name)
    }
    fn kinds(&mut self, layer: usize, kinds: Vec<String>) {
        Page::kinds(self, layer, kinds);
    }
    fn moves(&mut self, layer: usize, motion: Motion) {
        Page::moves(self, layer, motion);
    }
    fn surface(&mut self, surface: Surface) {
        Page::surface(self, surface);
    }
    fn push(&mut self, layer: usize, time: f64, table: Table) -> Result<(), ViewError> {
        Page::push(self, layer, time, &table)
    }
    fn wants_points(&self) -> bool {
        self.picks()
    }
}

/// The name without its folder.
pub fn short_name(source: &Source) -> String {
    let file = source.path().and_then(|path| path.file_name());
    file.map_or_else(|| source.to_string(), |name| name.to_string_lossy().into_owned())
}

/// Reads every input into `show`; what was found, for the report.
pub fn read_all(sources: &[Source], show: &mut impl Show) -> anyhow::Result<Vec<Value>> {
    let mut found = Vec::new();
    for source in sources {
        let mut from = source.open()?;
        let mut head = Vec::new();
        from.by_ref()
            .take(MCAP.len() as u64)
            .read_to_end(&mut head)
            .with_context(|| format!("{source}: cannot read"))?;
        let is_mcap = head == MCAP;
        let whole = Cursor::new(head).chain(from);
        let name = short_name(source);
        if is_mcap && show.wants_points() {
            anyhow::bail!(
                "{source}: --pick is for a cloud that cloud-crop reads, and this is MCAP, a run or walls: leave --pick out"
            );
        }
        let layers = if is_mcap { run::read(whole, source, show) } else { scan(whole, &name, show) };
        found.extend(layers.with_context(|| source.to_string())?);
    }
    Ok(found)
}

/// A mesh, or a cloud; one whose points have a radius is a set of wall spheres, and of grains where each has an id.
fn scan(mut from: impl Read, name: &str, show: &mut impl Show) -> anyhow::Result<Vec<Value>> {
    let mut bytes = Vec::new();
    from.read_to_end(&mut bytes).with_context(|| format!("{name}: cannot read"))?;
    if has_faces(&bytes) && !show.wants_points() {
        return mesh(&bytes, name, show);
    }
    let (cloud, dropped) = cloud::from_bytes(bytes)?.finite();
    if dropped > 0 {
        cli::warn(&format!("{name}: {dropped} points without finite coordinates are not shown"));
    }
    let axis = |k: usize| Values::F64(cloud.points.iter().map(|p| p[k]).collect());
    let mut table = Table::with_rows(cloud.points.len());
    for (k, column) in ["x", "y", "z"].into_iter().enumerate() {
        table.push(column, axis(k))?;
    }
    for column in cloud.attributes.columns() {
        table.push(&column.name, column.values.clone())?;
    }
    let has = |column| table.get(column).is_some();
    let role = match (has("radius"), has("id")) {
        (true, true) => Role::Grains,
        (true, false) => Role::Walls,
        (false, _) => Role::Cloud,
    };
    let points = table.rows();
    let layer = show.layer(role, name);
    show.push(layer, 0.0, table)?;
    Ok(vec![json!({ "input": name, "points": points })])
}

/// Whether this is a PLY file with faces in it.
fn has_faces(bytes: &[u8]) -> bool {
    let head = bytes.split(|b| *b == b'\n').take_while(|line| !line.starts_with(b"end_header"));
    let mut counts = head.take(1000).filter_map(|line| line.strip_prefix(b"element face "));
    bytes.starts_with(b"ply") && counts.any(|count| count.iter().any(|digit| (b'1'..=b'9').contains(digit)))
}

/// A mesh of triangles, at rest.
fn mesh(mut bytes: &[u8], name: &str, show: &mut impl Show) -> anyhow::Result<Vec<Value>> {
    let mesh = cloud::read_mesh(&mut bytes)?;
    let faces = mesh.faces.len();
    let (shape, motion) = (SurfaceShape::Mesh(mesh), Motion::default());
    show.surface(Surface { name: name.to_owned(), shape, motion });
    Ok(vec![json!({ "input": name, "triangles": faces })])
}

//! Reads what is to be shown: runs and walls (MCAP), meshes (PLY with faces) and clouds, told apart by their content.

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
        let layers = if is_mcap { run::read(whole, &name, show) } else { still(whole, &name, show) };
        found.extend(layers.with_context(|| source.to_string())?);
    }
    Ok(found)
}

/// A mesh or a cloud.
fn still(mut from: impl Read, name: &str, show: &mut impl Show) -> anyhow::Result<Vec<Value>> {
    let mut bytes = Vec::new();
    from.read_to_end(&mut bytes).context("cannot read")?;
    if !show.wants_points() && has_faces(&bytes) { mesh(&bytes, name, show) } else { scan(bytes, name, show) }
}

/// Whether it is PLY whose head announces faces.
fn has_faces(bytes: &[u8]) -> bool {
    const END: &[u8] = b"end_header";
    let head = bytes.windows(END.len()).take(1 << 16).position(|w| w == END);
    let Some(head) = head.filter(|_| bytes.starts_with(b"ply")) else { return false };
    let words =
        |line: &[u8]| String::from_utf8_lossy(line).split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    bytes[..head].split(|b| *b == b'\n').map(words).any(|line| match &line[..] {
        [element, face, count] => element == "element" && face == "face" && count != "0",
        _ => false,
    })
}

fn mesh(mut bytes: &[u8], name: &str, show: &mut impl Show) -> anyhow::Result<Vec<Value>> {
    let mesh = cloud::read_mesh(&mut bytes)?;
    let found = json!({ "input": name, "vertices": mesh.vertices.len(), "faces": mesh.faces.len() });
    let shape = SurfaceShape::Mesh(mesh);
    show.surface(Surface { name: name.to_owned(), shape, motion: Motion::default() });
    Ok(vec![found])
}

/// A cloud; one whose points have a radius is a set of wall spheres, and of grains where each has an id.
fn scan(bytes: Vec<u8>, name: &str, show: &mut impl Show) -> anyhow::Result<Vec<Value>> {
    let (cloud, dropped) = cloud::read(Cursor::new(bytes))?.finite();
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
    let role = match (table.get("radius"), table.get("id")) {
        (None, _) => Role::Cloud,
        (Some(_), None) => Role::Walls,
        (Some(_), Some(_)) => Role::Grains,
    };
    let points = table.rows();
    let layer = show.layer(role, name);
    show.push(layer, 0.0, table)?;
    Ok(vec![json!({ "input": name, "points": points })])
}

//! The page as text: a header in JSON, and each column of bytes once, in base64.

use super::{
    Page, PageLayer, PageOptions,
    blobs::Blobs,
    page_rods,
    panes::{self, Framed, Pane},
    worn::WearTrack,
};
use crate::appearance::{colour, field, scale};
use crate::things::{extras, sheet};
use crate::{Diagram, Map, Role, ViewError};
use base64::{Engine, engine::general_purpose::STANDARD};
use geom::Vec3;
use serde_json::{Value, json};
use std::io::{self, Write};

const TEMPLATE: &str = include_str!("page.html");
const REGION: &str = include_str!("region.html");
const STYLE: &str = include_str!("page.css");
const SCRIPT: [&str; 16] = [
    include_str!("data.js"),
    include_str!("camera.js"),
    include_str!("card.js"),
    include_str!("gpu.js"),
    include_str!("draw.js"),
    include_str!("sheet.js"),
    include_str!("solids.js"),
    include_str!("cut.js"),
    include_str!("find.js"),
    include_str!("legend.js"),
    include_str!("plots.js"),
    include_str!("play.js"),
    include_str!("panel.js"),
    include_str!("keys.js"),
    include_str!("touch.js"),
    include_str!("main.js"),
];
/// What a page has of rods, and without any.
const RODS: [&str; 2] = [include_str!("rods.js"), include_str!("rods_off.js")];
/// What a page has of walls that are coloured, and what of others.
const WORN: [&str; 3] = [include_str!("worn.js"), include_str!("worn.vert"), include_str!("worn.html")];
const WORN_OFF: [&str; 3] = [include_str!("worn_off.js"), include_str!("worn_off.vert"), ""];
/// What a page has besides on which regions are drawn.
const REGIONS: [&str; 2] = [include_str!("shape.js"), include_str!("region.js")];
const SHADERS: [(&str, &str); 8] = [
    ("ball-vert", concat!(include_str!("paint.vert"), include_str!("ball.vert"))),
    ("ball-frag", include_str!("ball.frag")),
    ("dot-frag", include_str!("dot.frag")),
    ("sheet-vert", include_str!("sheet.vert")),
    ("sheet-frag", include_str!("sheet.frag")),
    ("mesh-frag", include_str!("mesh.frag")),
    ("light-vert", include_str!("light.vert")),
    ("light-frag", include_str!("light.frag")),
];

/// Those of clumps that are polyhedra.
const SOLID_SHADERS: [(&str, &str); 2] = [
    ("solid-vert", concat!(include_str!("paint.vert"), include_str!("solid.vert"))),
    ("solid-frag", include_str!("solid.frag")),
];

/// Those of bonds, cracks and arrows.
const ROD_SHADERS: [(&str, &str); 2] =
    [("rod-vert", include_str!("rod.vert")), ("rod-frag", include_str!("rod.frag"))];

/// Counts what passes.
struct Counted<W> {
    to: W,
    bytes: u64,
}

impl<W: Write> Write for Counted<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.to.write(bytes)?;
        self.bytes += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.to.flush()
    }
}

impl Page {
    /// The page as one text.
    ///
    /// # Errors
    /// Nothing to show, or no layer has the field to colour by.
    pub fn html(&self) -> Result<String, ViewError> {
        let mut bytes = Vec::new();
        self.check()?;
        // Writing to memory does not fail.
        let _ = self.write_checked(&mut bytes);
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }

    /// Whether the page can be written: something to show, and the colour asked for.
    ///
    /// # Errors
    /// Nothing to show, or no layer has the field to colour by.
    pub fn check(&self) -> Result<(), ViewError> {
        let layers: Vec<&PageLayer> = self.layers.iter().filter(|l| is_shown(l)).collect();
        if layers.is_empty() && self.surfaces.is_empty() {
            return Err(ViewError::Empty);
        }
        let mut known: Vec<String> =
            layers.iter().flat_map(|l| l.fields.iter().map(|f| f.name.clone())).collect();
        known.extend(["x", "y", "z"].map(str::to_owned));
        known.extend(self.sizes.classes().map(|_| field::SIZE.to_owned()));
        match self.options.colour.as_deref().map(field::canonical) {
            Some(name) if name != "rgb" && !known.iter().any(|k| k == name) => {
                Err(ViewError::NoField { what: "colour", name: name.to_owned(), known })
            }
            _ => Ok(()),
        }
    }

    /// Writes the page, and says how many bytes it has; [`Page::check`] first.
    ///
    /// # Errors
    /// What the writer says.
    pub fn write_checked(&self, out: &mut impl Write) -> io::Result<u64> {
        let out = &mut Counted { to: out, bytes: 0 };
        let framed = self.framed();
        let mut blobs = Blobs::default();
        let mut header = self.header(&framed, &mut blobs);
        let (script, shaders) = (self.script(), self.shaders());
        header["bytes"] = json!(page_size(&blobs, &header, &script, &shaders));
        // `<` cannot end the script that the text stands in when it is written as an escape.
        let header = header.to_string().replace('<', "\\u003c");
        for (n, piece) in TEMPLATE.split("{{").enumerate() {
            let (slot, rest) =
                if n == 0 { ("", piece) } else { piece.split_once("}}").unwrap_or(("", piece)) };
            match slot {
                "theme" if self.options.dark => out.write_all(b" data-theme=\"dark\"")?,
                "title" => out.write_all(escaped(&self.options.title).as_bytes())?,
                "notes" => {
                    let note = |text: &String| format!("<p class=\"stop\">{}</p>", escaped(text));
                    out.write_all(self.notes.iter().map(note).collect::<String>().as_bytes())?;
                }
                "walls" => out.write_all(self.worn_parts()[2].as_bytes())?,
                "regions" if self.options.pick.is_some() => out.write_all(REGION.as_bytes())?,
                "style" => out.write_all(slim(STYLE).as_bytes())?,
                "shaders" => out.write_all(shaders.as_bytes())?,
                "header" => out.write_all(header.as_bytes())?,
                "blobs" => write_blobs(&blobs, out)?,
                "script" => out.write_all(script.as_bytes())?,
                _ => {}
            }
            out.write_all(rest.as_bytes())?;
        }
        Ok(out.bytes)
    }

    fn script(&self) -> String {
        let regions: &[&str] = if self.options.pick.is_some() { &REGIONS } else { &[] };
        // The last part starts what the others define.
        let (last, parts) = SCRIPT.split_last().unwrap_or((&"", &[]));
        let rods = RODS[usize::from(!self.has_rods())];
        slim(&[parts, &[rods, self.worn_parts()[0]], regions, &[*last]].concat().concat())
    }

    /// Script, part of a program for the graphics card, and settings of walls.
    fn worn_parts(&self) -> [&'static str; 3] {
        if self.options.walls.is_some() { WORN } else { WORN_OFF }
    }

    fn shaders(&self) -> String {
        let rods = self.has_rods();
        let solids = self.layers.iter().any(|l| !l.solids.is_empty());
        let more = [(rods, &ROD_SHADERS), (solids, &SOLID_SHADERS)];
        let all = SHADERS.iter().chain(more.iter().filter(|m| m.0).flat_map(|m| m.1));
        let whole = |text: &str| slim(&text.replace("{{worn}}", self.worn_parts()[1]));
        all.map(|(id, text)| format!("<script type=\"x-shader\" id=\"{id}\">{}</script>\n", whole(text)))
            .collect()
    }

    fn header<'a>(&'a self, framed: &'a Framed, blobs: &mut Blobs<'a>) -> Value {
        let kept = self.kept();
        let kinds: Vec<_> = (0..colour::KIND_COUNT).map(colour::kind).collect();
        let map = Map::ALL.iter().find(|(_, m)| *m == self.options.map).map(|(name, _)| *name);
        let camera = &self.options.camera;
        let outlines = framed.outlines.iter().zip(&framed.strays);
        let with_outline = self.layers.iter().zip(outlines).filter(|(l, _)| is_shown(l));
        json!({
            "title": self.options.title,
            "maps": self.maps_json(), "kinds": kinds, "wall": colour::WALL,
            // Beside force chains, whose they are, grains have others.
            "map": if self.has_chains() { Some("viridis") } else { map },
            "colour": self.options.colour.as_deref().map(field::canonical),
            "range": self.options.range.filter(|_| !self.has_chains()),
            "time": self.options.time,
            "camera": {
                "towards": camera.towards_eye.as_slice(),
                "eye": camera.eye.map(|e| [e.x, e.y, e.z]),
                "target": camera.target.map(|t| [t.x, t.y, t.z]),
            },
            "sizes": self.sizes.classes().map(|c| json!({
                "names": c.names, "edges": c.edges, "lo": c.range.lo, "hi": c.range.hi,
            })),
            "rods": { "bond": extras::BOND, "crack": extras::CRACK, "head": extras::HEAD, "grains": self.size_of_grains() },
            "plots": self.diagrams.iter().map(Diagram::to_json).collect::<Vec<_>>(),
            "given": kept.given, "stride": kept.stride,
            "lengthsOnly": kept.lengths_only, "mostBytes": self.options.most_bytes,
            "pick": self.options.pick, "onePointOf": kept.one_point_of,
            "positionError": kept.position_error, "radiusError": kept.radius_error,
            "clock": self.times(),
            "lo": framed.extent.map(|r| r.lo), "hi": framed.extent.map(|r| r.hi),
            "layers": with_outline.map(|(l, o)| self.hidden(l.role, &l.name, layer(l, o, blobs, &self.options))).collect::<Vec<_>>(),
            "walls": self.walls_json(),
            "surfaces": framed.panes.iter().zip(0..).map(|(p, n)| {
                self.hidden(Role::Walls, &p.name, pane(p, self.worn.get(&n), blobs))
            }).collect::<Vec<_>>(),
        })
    }
}

/// Whether the layer has anything in it, ever.
fn is_shown(layer: &PageLayer) -> bool {
    layer.frames.iter().any(|f| f.count > 0)
}

/// Bytes of the page, to a few.
fn page_size(blobs: &Blobs, header: &Value, script: &str, shaders: &str) -> usize {
    let packed: usize = blobs.list.iter().map(|b| b.len().div_ceil(3) * 4 + 45).sum();
    TEMPLATE.len() + slim(STYLE).len() + shaders.len() + script.len() + packed + header.to_string().len()
}

fn pane<'a>(pane: &'a Pane, worn: Option<&'a WearTrack>, blobs: &mut Blobs<'a>) -> Value {
    let [vertices, faces, lines] = [&pane.vertices, &pane.faces, &pane.lines].map(|b| blobs.number(b));
    let mut packed = json!({
        "name": pane.name, "motion": panes::motion(&pane.motion), "origin": panes::triple(&pane.origin),
        "vertices": vertices, "faces": faces, "lines": lines, "ink": pane.ink,
        "faceCount": pane.faces.len() / 12, "normal": pane.normal.as_ref().map(panes::triple),
        "outline": pane.outline.iter().map(panes::triple).collect::<Vec<_>>(),
    });
    if let Some(worn) = worn {
        packed["parts"] = json!(pane.parts.as_ref().map(|parts| blobs.number(parts)));
        worn.add_to(&mut packed, blobs);
    }
    packed
}

fn layer<'a>(
    layer: &'a PageLayer,
    (outline, strays): (&Vec<Vec3>, &Vec<Vec3>),
    blobs: &mut Blobs<'a>,
    options: &PageOptions,
) -> Value {
    let places = |of: &[Vec3]| of.iter().map(panes::triple).collect::<Vec<_>>();
    let mut frames = Vec::new();
    for frame in layer.frames.iter() {
        let mut packed = json!({
            "time": frame.time,
            "count": frame.count,
            "lo": frame.extent.map(|r| r.lo),
            "hi": frame.extent.map(|r| r.hi),
            "position": blobs.number(&frame.position),
            "radius": blobs.column(&frame.radius),
            "fields": frame.fields.iter().map(|f| blobs.column(f)).collect::<Vec<_>>(),
        });
        if frame.grains.clumps > 0 {
            packed["clumps"] = json!(frame.grains.clumps);
            packed["members"] = json!(frame.grains.members);
        }
        if !frame.solids.is_empty() {
            packed["solids"] = json!(blobs.number(&frame.solids));
        }
        frames.push(packed);
    }
    let fields = layer.fields.iter().map(|f| {
        let shown = f.most.opened();
        named_field(&f.name, f.whole, [f.all.lo, f.all.hi], [shown.lo, shown.hi])
    });
    let extent = sheet::box_of(&layer.outline.points());
    let axes = (0..3).map(|k| {
        let of = extent[k];
        named_field(["x", "y", "z"][k], false, [of.lo, of.hi], [of.lo, of.hi])
    });
    let mut packed = json!({
        "name": layer.name,
        "role": layer.role.word(),
        "main": layer.role == Role::Grains,
        "kinds": layer.kinds,
        "pointRadius": layer.point_radius,
        "exact": layer.exact.as_ref().map(|e| json!([blobs.number(&e.bytes), e.width])),
        "marks": layer.exact.as_ref().and_then(|e| e.marks.as_ref()).map(|marks| blobs.number(marks)),
        "motion": panes::motion(&layer.motion),
        "fields": fields.chain(axes).collect::<Vec<_>>(),
        "outline": places(outline),
        "strays": places(strays),
        "solids": layer.solids.header(|bytes| blobs.number(bytes)),
        "frames": frames,
    });
    page_rods::add_to(&mut packed, layer, options);
    layer.wear.add_to(&mut packed, blobs);
    packed
}

fn named_field(name: &str, whole: bool, all: [f64; 2], shown: [f64; 2]) -> Value {
    let (unit, factor) = scale::readable(field::unit(name), shown[0].abs().max(shown[1].abs()));
    let mut field = json!({ "name": name, "whole": whole, "things": whole && field::names_things(name), "unit": unit, "factor": factor, "all": all, "shown": shown });
    let codes = field::codes(name, &[]);
    if !codes.is_empty() {
        field["codes"] = json!(codes);
    }
    field
}

/// A program without indentation and without lines of comments.
fn slim(text: &str) -> String {
    let lines = text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with("//"));
    lines.flat_map(|line| [line, "\n"]).collect()
}

fn write_blobs(blobs: &Blobs, out: &mut impl Write) -> io::Result<()> {
    for (n, bytes) in blobs.list.iter().enumerate() {
        write!(out, "<script type=\"x-bytes\" id=\"b{n}\">")?;
        // A multiple of 3 bytes at a time, so that the pieces of text join.
        for piece in bytes.chunks(3 << 16) {
            out.write_all(STANDARD.encode(piece).as_bytes())?;
        }
        out.write_all(b"</script>\n")?;
    }
    Ok(())
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

//! The files of a library.

use crate::Entry;
use crate::args::Args;
use anyhow::Context;
use cli::OutputStream;
use geom::Vec3;
use photos::Camera;
use photos::rendered::Studio;
use photos::sheet::{Thumbnail, sheet};
use std::fmt::Write as _;
use stream::ply::Encoding;

/// Pictures of a sheet, at most.
const PICTURES: usize = 600;
/// Width and height of a picture [px].
const SIZE: [usize; 2] = [160, 120];

pub fn write(args: &Args, all: &[Entry], names: &[String]) -> anyhow::Result<()> {
    let folder = &args.folder;
    std::fs::create_dir_all(folder)
        .with_context(|| format!("{}: cannot make the folder", folder.display()))?;
    let progress = cli::Progress::new("stones", all.len() as u64);
    let mut pictures = Vec::new();
    for (entry, name) in all.iter().zip(names) {
        let mut out = OutputStream::file(&folder.join(name).with_extension("ply"))?;
        let says = [format!("{}: {}", entry.kind, entry.source)];
        mesh::write_ply(&mut out, &entry.stone.mesh, &says, Encoding::BinaryLittleEndian)?;
        out.commit()?;
        if pictures.len() < PICTURES {
            pictures.push(picture(entry));
        }
        progress.add(1);
    }
    if all.len() > PICTURES {
        cli::warn(&format!("sheet.png shows the first {PICTURES} stones"));
    }
    OutputStream::write_file(&folder.join("table.csv"), table(all, names).as_bytes())?;
    let variants: Vec<bool> = all.iter().map(|e| e.kind == "variant").collect();
    OutputStream::write_file(&folder.join("sheet.png"), &sheet(&pictures, &variants)?)
}

/// One stone a line.
fn table(all: &[Entry], names: &[String]) -> String {
    let mut out = "number,name,kind,source,faces,volume,area,sieve_size,length,width,thickness,elongation,flatness,convexity,sphericity,roundness\n".to_owned();
    for (k, (entry, name)) in all.iter().zip(names).enumerate() {
        let (s, [l, i, t]) = (&entry.shape, entry.shape.sides);
        let source = entry.source.replace('"', "\"\"");
        let _ = writeln!(
            out,
            "{},{name},{},\"{source}\",{},{},{},{},{l},{i},{t},{},{},{},{},{}",
            k + 1,
            entry.kind,
            entry.stone.mesh.faces.len(),
            s.volume,
            s.area,
            s.sieve_size,
            s.elongation,
            s.flatness,
            s.convexity,
            s.sphericity,
            s.roundness
        );
    }
    out
}

/// A stone from its side and a little above, all of one size.
fn picture(entry: &Entry) -> Thumbnail {
    let reach = entry.stone.reach();
    let plain = Studio {
        paint: [0.6; 2],
        background: [0.03; 2],
        blur: 0.0,
        noise: 0.0,
        ..Studio::new(SIZE[0], SIZE[1], reach)
    };
    let centre = entry.stone.moments.centre;
    let middle = [0, 1].map(|k| (SIZE[k] as f64 - 1.0) / 2.0);
    let eye = centre + Vec3::new(0.5, -0.75, 0.45) * 8.0 * reach;
    let camera = Camera::looking(eye, centre, Vec3::z(), 3.6 * SIZE[1] as f64, middle);
    Thumbnail::plain(&plain.photograph(&entry.stone.mesh, &camera).0)
}

//! Files in the wrong place of the command line: a second scene, a run as the scene, a cloud as walls, a file twice.

use cli::Source;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

/// What an MCAP file begins with.
pub const MCAP: [u8; 5] = *b"\x89MCAP";

/// Whether a file begins with these bytes; nothing is read from a pipe, which could not be read again.
fn begins(path: &Path, with: &[u8]) -> bool {
    let mut head = vec![0; with.len()];
    path.is_file() && File::open(path).and_then(|mut file| file.read_exact(&mut head)).is_ok() && head == with
}

/// Refuses a scene that is none, by its first bytes.
///
/// # Errors
/// Wrong usage, with the command that was meant.
pub fn scene(source: &Source) -> anyhow::Result<()> {
    let Some(path) = source.path() else { return Ok(()) };
    if begins(path, &MCAP) {
        return Err(cli::usage(format!(
            "{source} is an MCAP file, and the first file is the scene: dem-run SCENE.toml {source} if it holds walls or an \
             inlet, dem-run SCENE.toml --resume {source} to continue a run"
        )));
    }
    if begins(path, b"ply") {
        return Err(cli::usage(format!(
            "{source} is a cloud or a mesh, and the first file is the scene (TOML): {}",
            AS_WALLS
        )));
    }
    Ok(())
}

/// What to do with geometry.
const AS_WALLS: &str =
    "make walls of a cloud with wallgen, or name a drawing in the scene: [[wall]] mesh = \"FILE\"";

/// Refuses inputs that are neither walls nor an inlet but a known kind of file.
///
/// # Errors
/// Wrong usage, with the command that was meant.
pub fn inputs(scene: &Source, inputs: &[Source]) -> anyhow::Result<()> {
    for source in inputs {
        let Some(path) = source.path() else { continue };
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
        match ending.as_deref() {
            Some("toml") if path.is_file() && !begins(path, &MCAP) => {
                return Err(cli::usage(format!(
                    "{source} is a second scene, and a run has one: run them one after the other, \
                     dem-run {scene} -o A.mcap && dem-run {source} -o B.mcap"
                )));
            }
            Some("ply" | "stl" | "obj" | "las" | "laz" | "e57" | "pcd" | "xyz" | "pts")
                if path.is_file() && !begins(path, &MCAP) =>
            {
                return Err(cli::usage(format!("{source} holds no walls of dem-run: {AS_WALLS}")));
            }
            _ => {}
        }
    }
    Ok(())
}

/// Refuses a file that is given twice, also under two names.
///
/// # Errors
/// The first such file.
pub fn given_once(sources: &[Source]) -> anyhow::Result<()> {
    let files = || sources.iter().filter_map(Source::path).filter(|path| path.is_file());
    for (n, later) in files().enumerate() {
        for earlier in files().take(n) {
            if same_file(earlier, later).unwrap_or(false) {
                anyhow::bail!("{}: is given twice; leave one out", later.display());
            }
        }
    }
    Ok(())
}

/// Whether two files are one, or hold the same; reads them only when their lengths are equal.
fn same_file(a: &Path, b: &Path) -> io::Result<bool> {
    if a.canonicalize()? == b.canonicalize()? {
        return Ok(true);
    }
    let (mut a, mut b) = (BufReader::new(File::open(a)?), BufReader::new(File::open(b)?));
    if a.get_ref().metadata()?.len() != b.get_ref().metadata()?.len() {
        return Ok(false);
    }
    loop {
        let (x, y) = (a.fill_buf()?, b.fill_buf()?);
        let count = x.len().min(y.len());
        if count == 0 || x[..count] != y[..count] {
            return Ok(x.is_empty() && y.is_empty());
        }
        a.consume(count);
        b.consume(count);
    }
}

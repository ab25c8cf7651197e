//! A film as MP4 (H.264), packed by the program ffmpeg.

use crate::{Image, ViewError};
use std::{
    io::{ErrorKind, Read, Write},
    path::{Path, PathBuf},
    process::{Child, ChildStdin, Command, Stdio},
};
use tempfile::TempPath;

/// Fixed, so that the bytes do not depend on the machine's number of cores.
const THREADS: &str = "4";

/// H.264 wants even sides; the colours are those of high-definition video, and say so.
const FILTER: &str =
    "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white,scale=out_color_matrix=bt709:out_range=tv,format=yuv420p";

/// An MP4 file in the making.
pub struct Mp4 {
    ffmpeg: Child,
    to: ChildStdin,
    temp: TempPath,
    path: PathBuf,
}

/// Checks that the program ffmpeg is there.
///
/// # Errors
/// It is not, or cannot be started.
pub fn find_ffmpeg() -> Result<(), ViewError> {
    let mut program = Command::new("ffmpeg");
    program.arg("-version").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    program.status().map(drop).map_err(not_started)
}

fn not_started(error: std::io::Error) -> ViewError {
    match error.kind() {
        ErrorKind::NotFound => ViewError::NoFfmpeg,
        _ => ViewError::io("ffmpeg: cannot start it")(error),
    }
}

impl Mp4 {
    /// Begins a film of pictures of a size [pixel], so many a second, in the file `path`.
    ///
    /// # Errors
    /// A folder that cannot be written to, a program that cannot be started.
    pub fn begin(path: &Path, [width, height]: [u32; 2], fps: u32) -> Result<Mp4, ViewError> {
        let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let stem = path.file_name().unwrap_or_default().to_string_lossy();
        let temp = tempfile::Builder::new().prefix(&format!(".{stem}.")).suffix(".part").tempfile_in(folder);
        let create =
            format!("{}: cannot create it (check that the folder exists and is writable)", path.display());
        let (temp, path) = (temp.map_err(ViewError::io(create))?.into_temp_path(), path.to_owned());
        let (size, rate) = (format!("{width}x{height}"), fps.to_string());
        let mut ffmpeg = Command::new("ffmpeg")
            .args(["-hide_banner", "-loglevel", "error", "-nostdin", "-y"])
            .args(["-f", "rawvideo", "-pixel_format", "rgb24", "-video_size", &size])
            .args(["-framerate", &rate, "-i", "pipe:0", "-vf", FILTER])
            .args(["-c:v", "libx264", "-preset", "medium", "-crf", "18", "-threads", THREADS])
            .args(["-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709"])
            .args(["-fflags", "+bitexact", "-flags:v", "+bitexact", "-movflags", "+faststart", "-f", "mp4"])
            .arg(&temp)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(not_started)?;
        let to = ffmpeg.stdin.take().ok_or(ViewError::Ffmpeg { why: "no pipe to it".into() })?;
        Ok(Mp4 { ffmpeg, to, temp, path })
    }

    /// Adds a picture.
    ///
    /// # Errors
    /// The program has ended; the error holds its last words.
    pub fn add(&mut self, image: &Image) -> Result<(), ViewError> {
        let rgb: Vec<u8> = image.rgba.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
        match self.to.write_all(&rgb) {
            Err(e) if e.kind() == ErrorKind::BrokenPipe => {
                let why = words(&mut self.ffmpeg);
                // Only its end is waited for.
                let _ = self.ffmpeg.wait();
                Err(ViewError::Ffmpeg {
                    why: format!("failed: {why}: check that this ffmpeg has libx264, or write a .gif"),
                })
            }
            other => other.map_err(ViewError::io("ffmpeg: cannot write to it")),
        }
    }

    /// Ends the film and gives the file its name.
    ///
    /// # Errors
    /// The program failed, a file that cannot be renamed.
    pub fn finish(self) -> Result<(), ViewError> {
        let Mp4 { mut ffmpeg, to, temp, path } = self;
        drop(to);
        let why = words(&mut ffmpeg);
        let ended = ffmpeg.wait().map_err(ViewError::io("ffmpeg: cannot wait for it"))?;
        if !ended.success() {
            return Err(ViewError::Ffmpeg { why: format!("failed ({ended}): {why}") });
        }
        let rename = format!("{}: cannot rename to it", path.display());
        open_to_all(&temp).map_err(ViewError::io(rename.clone()))?;
        temp.persist(&path).map_err(|e| ViewError::io(rename)(e.error))
    }
}

/// The last line that the program wrote to stderr.
fn words(ffmpeg: &mut Child) -> String {
    let mut text = String::new();
    // Words that cannot be read are missing from the message.
    let _ = ffmpeg.stderr.as_mut().map(|e| e.read_to_string(&mut text));
    text.lines().next_back().unwrap_or("it gave no reason").to_owned()
}

/// A temporary file is its owner's only; this one stays.
#[cfg(unix)]
fn open_to_all(file: &Path) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    std::fs::set_permissions(file, std::fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn open_to_all(_: &Path) -> std::io::Result<()> {
    Ok(())
}

//! A film as MP4 (H.264), packed by the program ffmpeg.

use crate::{Image, ViewError};
use std::{
    io::{ErrorKind, Read, Write},
    path::Path,
    process::{Child, ChildStdin, Command, Stdio},
};

/// Fixed, so that the bytes do not depend on the machine's number of cores.
const THREADS: &str = "4";

/// H.264 wants even sides; the colours are those of high-definition video, and say so.
const FILTER: &str =
    "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white,scale=out_color_matrix=bt709:out_range=tv,format=yuv420p";

/// An MP4 file in the making.
pub struct Mp4 {
    ffmpeg: Child,
    to: ChildStdin,
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
    /// Begins a film of pictures of a size [pixel], so many a second, in the file `path`, whose name need not tell what it is.
    ///
    /// # Errors
    /// A program that cannot be started.
    pub fn begin(path: &Path, [width, height]: [u32; 2], fps: u32) -> Result<Mp4, ViewError> {
        let (size, rate) = (format!("{width}x{height}"), fps.to_string());
        let mut ffmpeg = Command::new("ffmpeg")
            .args(["-hide_banner", "-loglevel", "error", "-nostdin", "-y"])
            .args(["-f", "rawvideo", "-pixel_format", "rgb24", "-video_size", &size])
            .args(["-framerate", &rate, "-i", "pipe:0", "-vf", FILTER])
            .args(["-c:v", "libx264", "-preset", "medium", "-crf", "18", "-threads", THREADS])
            .args(["-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709"])
            .args(["-fflags", "+bitexact", "-flags:v", "+bitexact", "-movflags", "+faststart", "-f", "mp4"])
            .arg(path)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(not_started)?;
        let to = ffmpeg.stdin.take().ok_or(ViewError::Ffmpeg { why: "no pipe to it".into() })?;
        Ok(Mp4 { ffmpeg, to })
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

    /// Ends the film.
    ///
    /// # Errors
    /// The program failed.
    pub fn finish(self) -> Result<(), ViewError> {
        let Mp4 { mut ffmpeg, to } = self;
        drop(to);
        let why = words(&mut ffmpeg);
        let ended = ffmpeg.wait().map_err(ViewError::io("ffmpeg: cannot wait for it"))?;
        match ended.success() {
            true => Ok(()),
            false => Err(ViewError::Ffmpeg { why: format!("failed ({ended}): {why}") }),
        }
    }
}

/// The last line that the program wrote to stderr.
fn words(ffmpeg: &mut Child) -> String {
    let mut text = String::new();
    // Words that cannot be read are missing from the message.
    let _ = ffmpeg.stderr.as_mut().map(|e| e.read_to_string(&mut text));
    text.lines().next_back().unwrap_or("it gave no reason").to_owned()
}

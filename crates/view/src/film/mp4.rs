//! A film as MP4 (H.264), packed by the program ffmpeg.

use anyhow::Context;
use cli::Output;
use std::{
    io::{ErrorKind, Read, Write},
    path::{Path, PathBuf},
    process::{Child, ChildStdin, Command, Stdio},
};
use tempfile::TempPath;
use view::Image;

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

/// Whether ffmpeg is there.
pub fn find() -> anyhow::Result<()> {
    let silent = || (Stdio::null(), Stdio::null(), Stdio::null());
    let (stdin, stdout, stderr) = silent();
    let found = Command::new("ffmpeg").arg("-version").stdin(stdin).stdout(stdout).stderr(stderr).status();
    found.map(|_| ()).map_err(unfound)
}

fn unfound(error: std::io::Error) -> anyhow::Error {
    if error.kind() == ErrorKind::NotFound {
        anyhow::anyhow!(
            "MP4 is packed by the program ffmpeg, which is not on the PATH: install it (apt install ffmpeg, \
             brew install ffmpeg), or write a .gif, which needs no other program"
        )
    } else {
        anyhow::Error::new(error).context("ffmpeg: cannot start it")
    }
}

impl Mp4 {
    /// Begins a film of pictures of `size`, so many a second.
    pub fn begin(output: &Output, [width, height]: [u32; 2], fps: u32) -> anyhow::Result<Mp4> {
        let path = output.path().context("an MP4 needs a file: give -o NAME.mp4")?.to_owned();
        let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let stem = path.file_name().unwrap_or_default().to_string_lossy();
        let temp = tempfile::Builder::new().prefix(&format!(".{stem}.")).suffix(".part").tempfile_in(folder);
        let temp = temp
            .with_context(|| format!("{}: cannot create it (is the folder there?)", path.display()))?
            .into_temp_path();
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
            .map_err(unfound)?;
        let to = ffmpeg.stdin.take().context("ffmpeg: no pipe to it")?;
        Ok(Mp4 { ffmpeg, to, temp, path })
    }

    /// Adds a picture.
    pub fn add(&mut self, image: &Image) -> anyhow::Result<()> {
        let rgb: Vec<u8> = image.rgba.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
        match self.to.write_all(&rgb) {
            // It has ended before all was given: what it said is the reason.
            Err(e) if e.kind() == ErrorKind::BrokenPipe => Err(self.complaint()),
            other => other.context("ffmpeg: cannot write to it"),
        }
    }

    /// Ends the film and gives the file its name.
    pub fn finish(self) -> anyhow::Result<()> {
        let Mp4 { mut ffmpeg, to, temp, path } = self;
        drop(to);
        let said = words(&mut ffmpeg);
        let ended = ffmpeg.wait().context("ffmpeg: cannot wait for it")?;
        anyhow::ensure!(ended.success(), "ffmpeg failed ({ended}): {said}");
        open_to_all(&temp)?;
        temp.persist(&path).with_context(|| format!("{}: cannot rename to it", path.display()))
    }

    fn complaint(&mut self) -> anyhow::Error {
        let said = words(&mut self.ffmpeg);
        // Only its end is waited for.
        let _ = self.ffmpeg.wait();
        anyhow::anyhow!("ffmpeg failed: {said}: is it one with libx264? Else write a .gif")
    }
}

fn words(ffmpeg: &mut Child) -> String {
    let mut said = String::new();
    // Words that cannot be read are missing from the message, no more.
    let _ = ffmpeg.stderr.as_mut().map(|e| e.read_to_string(&mut said));
    said.lines().next_back().unwrap_or("it did not say why").to_owned()
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

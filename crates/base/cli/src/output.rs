//! Outputs: stdout, or a file that appears under its name only when it is whole.

use crate::{
    OutPath,
    exit::usage,
    part::{Keep, PartFile},
    signals, stdout,
    target::{folder, is_descriptor, open_as_it_is, target},
};
use anyhow::Context;
use std::{
    fs::{self, File, Metadata},
    io::{self, BufWriter, IsTerminal, Seek, SeekFrom, Write},
    path::{Path, PathBuf},
};
use stream::mcap;

/// Enough that a pipe is filled by one write.
const BUFFER: usize = 1 << 18;

/// Capacity of a pipe between two tools [B]: the most that Linux allows without privileges.
#[cfg(target_os = "linux")]
const PIPE: usize = 1 << 20;

/// Lets a pipe hold more than its 64 KiB, so that two tools wait for each other less often; anything else stays as it is.
pub(crate) fn widen(stream: &impl std::os::fd::AsFd) {
    #[cfg(target_os = "linux")]
    let _ = rustix::pipe::fcntl_setpipe_size(stream, PIPE);
    #[cfg(not(target_os = "linux"))]
    let _ = stream;
}

/// Where a tool writes: flatten it into the tool's arguments.
#[derive(Debug, Clone, Default, clap::Args)]
pub struct Output {
    /// Write to FILE instead of stdout; FILE appears when it is complete
    #[arg(id = "output", short = 'o', long = "output", value_name = "FILE")]
    pub file: Option<OutPath>,
}

impl Output {
    /// The file, unless it is stdout (`-`).
    pub fn path(&self) -> Option<&Path> {
        self.file.as_deref().filter(|path| *path != Path::new("-"))
    }

    /// Whether the file's name ends in `.extension`, in any case of letters.
    pub fn has_extension(&self, extension: &str) -> bool {
        let ending = self.path().and_then(|path| path.extension());
        ending.is_some_and(|ending| ending.eq_ignore_ascii_case(extension))
    }

    /// Checks that the file's name ends as one of these formats does, or has no ending.
    ///
    /// # Errors
    /// Wrong usage: the ending is that of another format.
    pub fn check_ending(&self, formats: &[&str]) -> anyhow::Result<()> {
        let ending = self.path().and_then(Path::extension);
        if ending.is_none() || formats.iter().any(|format| self.has_extension(format)) {
            return Ok(());
        }
        let (names, endings) = (
            formats.iter().map(|f| f.to_uppercase()).collect::<Vec<_>>().join(" or "),
            formats.join(" or ."),
        );
        Err(usage(format!("-o {}: the output is {names}: use a name that ends in .{endings}", self.name())))
    }

    /// The name that messages use.
    pub fn name(&self) -> String {
        self.path().map_or_else(|| "stdout".to_owned(), |path| path.display().to_string())
    }

    /// The path of the unfinished file of [`Output::open_long`] as the user would write it; that of a link lies beside its target.
    pub fn name_of_part(&self, out: &OutputStream) -> Option<PathBuf> {
        let (path, part) = (self.path()?, out.part()?);
        let named = path.with_file_name(part.file_name()?);
        Some(if path.is_symlink() { part.to_owned() } else { named })
    }

    /// Whether the file holds exactly these bytes: then it can stay, with its time, and make runs nothing again that depends on it.
    pub fn holds(&self, bytes: &[u8]) -> bool {
        let same = |path: &Path| {
            let found = fs::metadata(path).ok()?;
            Some(found.is_file() && found.len() == bytes.len() as u64 && fs::read(path).ok()? == bytes)
        };
        self.path().and_then(same).unwrap_or(false)
    }

    /// Opens a binary stream. What is written to a file is lost unless [`OutputStream::commit`] is called.
    ///
    /// # Errors
    /// Wrong usage when stdout is a terminal; a folder that cannot be written to.
    pub fn open(&self) -> anyhow::Result<OutputStream> {
        if self.path().is_none() && io::stdout().is_terminal() {
            return Err(usage("stdout is a terminal and this output is binary: use -o FILE, or a pipe"));
        }
        self.open_text()
    }

    /// Opens a binary stream that takes long to write: a file is `NAME.part` until it is committed, in plain sight, and
    /// stays so when the tool does not come to its end, once [`OutputStream::keeper`] says so.
    ///
    /// # Errors
    /// As [`Output::open`].
    pub fn open_long(&self) -> anyhow::Result<OutputStream> {
        match self.path() {
            Some(path) => OutputStream::beside(path, PartFile::plain),
            None => self.open(),
        }
    }

    /// Opens a stream for text, which a terminal may show.
    ///
    /// # Errors
    /// A folder that cannot be written to.
    pub fn open_text(&self) -> anyhow::Result<OutputStream> {
        match self.path() {
            Some(path) => OutputStream::file(path),
            None => OutputStream::stdout(),
        }
    }
}

/// A buffered stream that is committed at the end.
pub struct OutputStream {
    sink: BufWriter<Sink>,
    name: String,
}

enum Sink {
    /// Stdout, a device or a named pipe: bytes go out as they are written. `waits`: a reader may be waiting for them; not where stdout is
    /// a file.
    Direct { file: File, waits: bool },
    /// Beside the final name.
    Pending { part: PartFile, path: PathBuf },
}

impl OutputStream {
    fn new(sink: Sink, name: String) -> OutputStream {
        OutputStream { sink: BufWriter::with_capacity(BUFFER, sink), name }
    }

    /// The process's stdout, past the line buffer of `std::io::Stdout`.
    ///
    /// # Errors
    /// A closed stdout.
    pub fn stdout() -> anyhow::Result<OutputStream> {
        use std::os::fd::AsFd;
        if stdout::is_closed() {
            anyhow::bail!("stdout is closed, and the output would be lost: use -o FILE, a pipe, or > FILE");
        }
        let stdout = io::stdout().as_fd().try_clone_to_owned().context("stdout: cannot open")?;
        widen(&stdout);
        let file = File::from(stdout);
        let waits = !file.metadata().is_ok_and(|kind| kind.is_file());
        Ok(OutputStream::new(Sink::Direct { file, waits }, "stdout".to_owned()))
    }

    /// A file that appears as `path` when it is committed.
    ///
    /// # Errors
    /// A folder that is missing or cannot be written to.
    pub fn file(path: &Path) -> anyhow::Result<OutputStream> {
        OutputStream::beside(path, PartFile::hidden)
    }

    /// Writes a whole file, which appears when it is complete.
    ///
    /// # Errors
    /// As [`OutputStream::file`]; a write that fails.
    pub fn write_file(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
        let mut out = OutputStream::file(path)?;
        out.write_all(bytes).with_context(|| path.display().to_string())?;
        out.commit()
    }

    fn beside(path: &Path, part: fn(&Path, &str) -> io::Result<PartFile>) -> anyhow::Result<OutputStream> {
        let name = path.display().to_string();
        let failed = || format!("{name}: cannot create it (check that the folder exists and is writable)");
        // A link stays a link: its target is replaced. Devices and named pipes are written to, not replaced.
        let target = target(path).with_context(failed)?;
        match fs::metadata(&target) {
            Ok(kind) if kind.is_dir() => anyhow::bail!("{name}: is a folder: name a file in it"),
            Ok(kind) if !kind.is_file() || is_descriptor(&target) => {
                let file = open_as_it_is(&target).with_context(failed)?;
                return Ok(OutputStream::new(Sink::Direct { file, waits: true }, name));
            }
            Err(_) if is_descriptor(&target) => {
                anyhow::bail!("{name}: is not open: redirect it to a file, or name one")
            }
            found => dangling(path, &target, found.ok()),
        }
        writable(&target).with_context(|| {
            let cure = "remove the protection (chmod u+w), or choose another name";
            link(path, &target, format!("{name}: exists and is write-protected: {cure}"))
        })?;
        let stem = target.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let part = signals::removed_on_signal(|| part(folder(&target), &stem))
            .with_context(|| link(path, &target, failed()))?;
        Ok(OutputStream::new(Sink::Pending { part, path: target }, name))
    }

    /// The name that messages use.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What decides whether the file stays unfinished beside its name when it is not committed; at first it does not.
    pub fn keeper(&self) -> Keep {
        match self.sink.get_ref() {
            Sink::Pending { part, .. } => part.keeper(),
            Sink::Direct { .. } => Keep::default(),
        }
    }

    /// The unfinished file.
    pub fn part(&self) -> Option<&Path> {
        match self.sink.get_ref() {
            Sink::Pending { part, .. } => part.path(),
            Sink::Direct { .. } => None,
        }
    }

    /// How an MCAP stream is written to it: packed into a file, whether it is named or stdout (the bytes are the same), and not packed to a
    /// reader that waits. A file that is stdout is not sought in: it may be appended to.
    pub fn how(&self) -> mcap::StreamOptions<OutputStream> {
        match self.sink.get_ref() {
            Sink::Direct { waits: true, .. } => mcap::Compression::None.into(),
            Sink::Direct { waits: false, .. } => mcap::Compression::Zstd.into(),
            Sink::Pending { .. } => mcap::StreamOptions {
                compression: mcap::Compression::Zstd,
                seeks: Some(|out, to| out.sink.seek(to)),
            },
        }
    }

    /// Flushes, and gives a file its name.
    ///
    /// # Errors
    /// A full disk, a closed pipe; then no file appears.
    pub fn commit(self) -> anyhow::Result<()> {
        let name = self.name;
        let mut sink = self.sink.into_inner().map_err(|e| e.into_error()).with_context(|| name.clone())?;
        sink.flush().with_context(|| name.clone())?;
        if let Sink::Pending { part, path } = sink {
            let warning = part.rename(&path).with_context(|| format!("{name}: cannot give it its name"))?;
            warning.iter().for_each(|warning| crate::warn(&format!("{name}: {warning}")));
        }
        Ok(())
    }
}

/// Warns of a link whose target does not exist: it is created where the link points.
fn dangling(path: &Path, target: &Path, found: Option<Metadata>) {
    if found.is_none() && path.is_symlink() {
        let (path, target) = (path.display(), target.display());
        crate::warn(&format!("{path} is a link to {target}, which does not exist: it is created there"));
    }
}

/// Whether a file may be replaced: only where it could be written to, as `>` of a shell would.
fn writable(target: &Path) -> io::Result<()> {
    match File::options().write(true).open(target) {
        Err(e) if matches!(e.kind(), io::ErrorKind::PermissionDenied) => Err(e),
        _ => Ok(()),
    }
}

/// What failed at the target of a link, or at the path itself.
fn link(path: &Path, target: &Path, failed: String) -> String {
    if path.is_symlink() { format!("{failed}; it is a link to {}", target.display()) } else { failed }
}

/// A limit on the size of files is not a full disk.
fn explained(error: io::Error) -> io::Error {
    match error.kind() {
        io::ErrorKind::FileTooLarge => {
            let text = "the file has the largest size that is allowed here (ulimit -f, or the file system)";
            io::Error::new(error.kind(), text)
        }
        _ => error,
    }
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Sink::Direct { file, .. } => file.write(bytes),
            Sink::Pending { part, .. } => part.file()?.write(bytes),
        }
        .map_err(explained)
    }
    fn flush(&mut self) -> io::Result<()> {
        match self {
            Sink::Direct { file, .. } => file.flush(),
            Sink::Pending { part, .. } => part.file()?.flush(),
        }
    }
}

impl Seek for Sink {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        match self {
            Sink::Direct { file, .. } => file.seek(to),
            Sink::Pending { part, .. } => part.file()?.seek(to),
        }
    }
}

impl Write for OutputStream {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.sink.write(bytes)
    }
    fn flush(&mut self) -> io::Result<()> {
        self.sink.flush()
    }
}

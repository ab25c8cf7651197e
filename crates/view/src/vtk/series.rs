//! Files for ParaView: one moment, or a series of them.

use crate::{
    Args, inputs,
    moment::Moment,
    series::{Layer, Series},
};
use anyhow::Context;
use cli::{Output, Report};
use std::{
    cell::RefCell,
    fs::{self, File},
    io::{self, BufWriter},
    path::{Path, PathBuf},
    rc::Rc,
};
use stream::Table;
use view::{
    ViewError,
    vtk::{self, Entry, PolyData, Reach},
};

/// One moment, in one file.
pub fn vtp(args: &Args, output: &Output) -> anyhow::Result<Report> {
    let mut moment = Moment::at(args.time);
    let seen = inputs::read_all(&args.inputs, &mut moment)?;
    moment.settle();
    let data = vtk::moment(&moment.parts(), moment.surfaces(), moment.time())?;
    let mut out = output.open()?;
    data.write(&mut out).with_context(|| output.name())?;
    out.commit()?;
    let summary = format!("{}: {} points, {} triangles", output.name(), data.len(), data.faces.len());
    Ok(Report::new(summary).with("time_s", moment.time()).with("layers", seen))
}

/// A folder of files, and the list that says which of them shows what at which time.
pub fn pvd(args: &Args, output: &Output) -> anyhow::Result<Report> {
    let path = output.path().context("a series needs a file and a folder: give -o NAME.pvd")?;
    let folder = Folder::beside(path)?;
    let reach = Rc::new(RefCell::new(Reach::default()));
    let mut series = Series::new(args.span(), folder.keeper(reach.clone()));
    let seen = inputs::read_all(&args.inputs, &mut series)?;
    let times = match series.times() {
        times if times.is_empty() => vec![0.0],
        times => times,
    };
    let mut entries = Vec::new();
    for (number, layer) in series.layers.iter().enumerate() {
        entries.extend(folder.list(number, layer, &times, &mut reach.borrow_mut())?);
    }
    if !series.surfaces.is_empty() {
        entries.extend(folder.surfaces(&series, &times, &reach.borrow())?);
    }
    if entries.is_empty() {
        return Err(ViewError::Empty.into());
    }
    let mut out = output.open_text()?;
    vtk::write_collection(&entries, &mut out).with_context(|| output.name())?;
    let files = folder.commit()?;
    out.commit()?;
    let summary = format!("{}: {} moments in {files} files", output.name(), times.len());
    Ok(Report::new(summary).with("moments", times.len()).with("files", files).with("layers", seen))
}

/// The folder of a series: filled beside its final name, and renamed when whole.
struct Folder {
    filling: tempfile::TempDir,
    place: PathBuf,
    name: String,
}

impl Folder {
    /// The folder `run` of `run.pvd`; one that is there already must be of this kind.
    fn beside(path: &Path) -> anyhow::Result<Folder> {
        let place = path.with_extension("");
        let name = place.file_name().context("no name before .pvd")?.to_string_lossy().into_owned();
        if place.exists() && !only_vtp(&place) {
            anyhow::bail!(
                "{}: is there, and holds more than the .vtp files of a series: remove it, or give another name",
                place.display()
            );
        }
        let parent = place.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let filling =
            tempfile::Builder::new().prefix(&format!(".{name}.")).suffix(".part").tempdir_in(parent);
        let filling = filling.with_context(|| {
            format!("{}: cannot create it (is the folder there, and may you write to it?)", place.display())
        })?;
        Ok(Folder { filling, place, name })
    }

    /// Writes each state to a file as it comes: a run that does not fit in memory can be shown.
    fn keeper(&self, reach: Rc<RefCell<Reach>>) -> KeepFile {
        let folder = self.filling.path().to_owned();
        Box::new(move |number, layer, time, table| {
            reach.borrow_mut().add(layer.role, &table, &layer.name)?;
            let file = format!("{}_{:05}.vtp", stem(number, layer), layer.states.len());
            let data = PolyData { time: Some(time), ..vtk::points(layer.role, &table) };
            write(&folder.join(&file), &data)?;
            Ok(file)
        })
    }

    /// Which file of a layer is shown at which time.
    fn list(
        &self,
        number: usize,
        layer: &Layer<String>,
        times: &[f64],
        reach: &mut Reach,
    ) -> Result<Vec<Entry>, ViewError> {
        let mut entries = Vec::new();
        for (n, &time) in times.iter().enumerate() {
            let file = if let Some(home) = &layer.home {
                let file = format!("{}_{n:05}.vtp", stem(number, layer));
                let table = record::moved(home, &layer.motion.pose(time));
                reach.add(layer.role, &table, &layer.name)?;
                let data = PolyData { time: Some(time), ..vtk::points(layer.role, &table) };
                write(&self.filling.path().join(&file), &data)?;
                file
            } else if let Some(file) = layer.at(time) {
                file.clone()
            } else {
                continue;
            };
            entries.push(self.entry(time, number, &layer.name, &file));
        }
        Ok(entries)
    }

    /// Planes and meshes: one file when none of them moves.
    fn surfaces(
        &self,
        series: &Series<String>,
        times: &[f64],
        reach: &Reach,
    ) -> Result<Vec<Entry>, ViewError> {
        let moves = series.surfaces.iter().any(|s| s.motion.moves());
        let mut entries = Vec::new();
        for (n, &time) in times.iter().enumerate() {
            let file = if moves { format!("surfaces_{n:05}.vtp") } else { "surfaces.vtp".to_owned() };
            if moves || n == 0 {
                write(&self.filling.path().join(&file), &vtk::walls(&series.surfaces, reach, time))?;
            }
            entries.push(self.entry(time, series.layers.len(), "surfaces", &file));
        }
        Ok(entries)
    }

    fn entry(&self, time: f64, part: usize, name: &str, file: &str) -> Entry {
        Entry { time, part, name: name.to_owned(), file: format!("{}/{file}", self.name) }
    }

    /// Gives the folder its name; how many files are in it.
    fn commit(self) -> anyhow::Result<usize> {
        let failed = || format!("{}: cannot rename to it", self.place.display());
        if self.place.exists() {
            fs::remove_dir_all(&self.place).with_context(failed)?;
        }
        let files = fs::read_dir(self.filling.path()).with_context(failed)?.count();
        open_to_all(self.filling.path()).with_context(failed)?;
        fs::rename(self.filling.path(), &self.place).with_context(failed)?;
        // It has its name now; there is nothing left to remove.
        let _ = self.filling.keep();
        Ok(files)
    }
}

type KeepFile = Box<dyn FnMut(usize, &Layer<String>, f64, Table) -> Result<String, ViewError>>;

/// The beginning of the names of a layer's files.
fn stem(number: usize, layer: &Layer<String>) -> String {
    let word: String = layer.name.chars().take_while(char::is_ascii_alphanumeric).collect();
    format!("{number}_{}", if word.is_empty() { "layer" } else { &word })
}

fn write(path: &Path, data: &PolyData) -> Result<(), ViewError> {
    let whole = || {
        let mut out = BufWriter::new(File::create(path)?);
        data.write(&mut out)?;
        io::Write::flush(&mut out)
    };
    whole().map_err(|source| ViewError::Keep { file: path.display().to_string(), source })
}

fn only_vtp(folder: &Path) -> bool {
    let is_vtp = |entry: io::Result<fs::DirEntry>| {
        entry.is_ok_and(|e| Path::new(&e.file_name()).extension().is_some_and(|x| x == "vtp"))
    };
    fs::read_dir(folder).is_ok_and(|mut entries| entries.all(is_vtp))
}

/// A temporary folder is its owner's only; this one stays.
#[cfg(unix)]
fn open_to_all(folder: &Path) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    fs::set_permissions(folder, fs::Permissions::from_mode(0o755))
}

#[cfg(not(unix))]
fn open_to_all(_: &Path) -> io::Result<()> {
    Ok(())
}

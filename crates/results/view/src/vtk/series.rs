//! A series of files for ParaView: a folder of `.vtp`, filled beside its final name and renamed when whole.

use super::polydata::escaped;
use super::{Entry, PolyData, Reach, points, walls};
use crate::ViewError;
use crate::reading::series::{KeepState, Series, SeriesLayer};
use std::cell::RefCell;
use std::collections::HashSet;
use std::fs::{self, File};
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// The folder of a series.
pub struct SeriesFolder {
    filling: tempfile::TempDir,
    place: PathBuf,
    name: String,
    /// The collection.
    list: PathBuf,
    /// The extent of all states so far.
    reach: Rc<RefCell<Reach>>,
}

impl SeriesFolder {
    /// The folder `run` of `run.pvd`. One that is there already is replaced if `run.pvd` lists all its files; a link to it stays a link.
    ///
    /// # Errors
    /// A folder that holds other files, or that cannot be created; a link to nothing.
    pub fn beside(path: &Path) -> Result<SeriesFolder, ViewError> {
        let place = path.with_extension("");
        let name = place.file_name().unwrap_or_default().to_string_lossy().into_owned();
        only_series(&place, &name, path)?;
        let place = if place.is_symlink() { end_of_link(&place)? } else { place };
        let parent = place.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let filling =
            tempfile::Builder::new().prefix(&format!(".{name}.")).suffix(".part").tempdir_in(parent);
        let create =
            format!("{}: cannot create it (check that the folder exists and is writable)", place.display());
        let filling = filling.map_err(ViewError::io(create))?;
        Ok(SeriesFolder { filling, place, name, list: path.to_owned(), reach: Rc::default() })
    }

    /// The folder that is being filled; it has a name of its own until all is there.
    pub fn filling(&self) -> &Path {
        self.filling.path()
    }

    /// Writes each state to a file as it comes: a run that does not fit in memory can be shown.
    pub fn keeper(&self) -> KeepState<String> {
        let (folder, reach) = (self.filling.path().to_owned(), self.reach.clone());
        Box::new(move |number, layer, time, table| {
            reach.borrow_mut().add(layer.head.role, &table, &layer.head.name)?;
            let file = format!("{}_{:05}.vtp", stem(number, layer), layer.states.len());
            let data = PolyData { time: Some(time), ..points(layer.head.role, &table) };
            write(&folder.join(&file), &data)?;
            Ok(file)
        })
    }

    /// Which file shows which layer at which time; files of layers that move are written here.
    ///
    /// # Errors
    /// Nothing to show, a file that cannot be written.
    pub fn entries(&self, series: &Series<String>, times: &[f64]) -> Result<Vec<Entry>, ViewError> {
        let mut entries = Vec::new();
        for (number, layer) in series.layers.iter().enumerate() {
            entries.extend(self.of_layer(number, layer, times)?);
        }
        if !series.surfaces.is_empty() {
            entries.extend(self.of_surfaces(series, times)?);
        }
        if entries.is_empty() { Err(ViewError::Empty) } else { Ok(entries) }
    }

    fn of_layer(
        &self,
        number: usize,
        layer: &SeriesLayer<String>,
        times: &[f64],
    ) -> Result<Vec<Entry>, ViewError> {
        let head = &layer.head;
        let mut entries = Vec::new();
        for (n, &time) in times.iter().enumerate() {
            let file = if let Some(home) = &layer.home {
                let file = format!("{}_{n:05}.vtp", stem(number, layer));
                let table = record::moved(home, &head.motion.pose(time));
                self.reach.borrow_mut().add(head.role, &table, &head.name)?;
                let data = PolyData { time: Some(time), ..points(head.role, &table) };
                write(&self.filling.path().join(&file), &data)?;
                file
            } else if let Some(file) = layer.at(time) {
                file.clone()
            } else {
                continue;
            };
            entries.push(self.entry(time, number, &head.name, &file));
        }
        Ok(entries)
    }

    /// Planes and meshes: one file when none of them moves.
    fn of_surfaces(&self, series: &Series<String>, times: &[f64]) -> Result<Vec<Entry>, ViewError> {
        let moves = series.surfaces.iter().any(|s| s.motion.moves());
        let mut entries = Vec::new();
        for (n, &time) in times.iter().enumerate() {
            let file = if moves { format!("surfaces_{n:05}.vtp") } else { "surfaces.vtp".to_owned() };
            if moves || n == 0 {
                let data = walls(&series.surfaces, &self.reach.borrow(), time);
                write(&self.filling.path().join(&file), &data)?;
            }
            entries.push(self.entry(time, series.layers.len(), "surfaces", &file));
        }
        Ok(entries)
    }

    fn entry(&self, time: f64, part: usize, name: &str, file: &str) -> Entry {
        Entry { time, part, name: name.to_owned(), file: format!("{}/{file}", self.name) }
    }

    /// Gives the folder its name; the number of files in it.
    ///
    /// # Errors
    /// A folder that cannot be renamed, or now holds other files.
    pub fn commit(self) -> Result<usize, ViewError> {
        let place = self.place.clone();
        // Files may have come since the folder was looked at.
        only_series(&place, &self.name, &self.list)?;
        let rename = || {
            if self.place.exists() {
                fs::remove_dir_all(&self.place)?;
            }
            let files = fs::read_dir(self.filling.path())?.count();
            open_to_all(self.filling.path())?;
            fs::rename(self.filling.path(), &self.place)?;
            // It has its name now; there is nothing left to remove.
            let _ = self.filling.keep();
            Ok(files)
        };
        rename().map_err(ViewError::io(format!("{}: cannot rename to it", place.display())))
    }
}

/// The beginning of the names of a layer's files.
fn stem(number: usize, layer: &SeriesLayer<String>) -> String {
    let word: String = layer.head.name.chars().take_while(char::is_ascii_alphanumeric).collect();
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

/// Refuses a folder with files that a collection does not list.
fn only_series(folder: &Path, name: &str, collection: &Path) -> Result<(), ViewError> {
    let refused = |file| {
        let [folder, list] = [folder, collection].map(|path| path.display().to_string());
        Err(ViewError::NotSeries { folder, file, list })
    };
    foreign_file(folder, name, collection).map_or(Ok(()), refused)
}

/// A file of a folder that a collection does not list: the folder is then not that of the collection's series.
fn foreign_file(folder: &Path, name: &str, collection: &Path) -> Option<String> {
    if !folder.exists() {
        return None;
    }
    let Ok(files) = fs::read_dir(folder) else { return Some(String::new()) };
    let files =
        files.map(|entry| entry.map_or(String::new(), |e| e.file_name().to_string_lossy().into_owned()));
    let listed = fs::read_to_string(collection).unwrap_or_default();
    let listed: HashSet<&str> =
        listed.split("file=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    let mut foreign: Vec<String> =
        files.filter(|file| !listed.contains(escaped(&format!("{name}/{file}")).as_str())).collect();
    foreign.sort_unstable();
    foreign.into_iter().next()
}

/// The folder that a link stands for.
fn end_of_link(link: &Path) -> Result<PathBuf, ViewError> {
    let cure = "make the folder that it names, or remove the link";
    fs::canonicalize(link).map_err(ViewError::io(format!("{}: is a link to nothing: {cure}", link.display())))
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

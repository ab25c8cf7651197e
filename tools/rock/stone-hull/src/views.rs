//! Photographs, masks and cameras become views.

use crate::args::Args;
use crate::{on_turntable, poses};
use anyhow::Context;
use photos::{Camera, Field, Mask, Turntable, View, photograph};
use rayon::prelude::*;
use std::path::{Path, PathBuf};

/// Samples of a distance field along the longest side of the stone, at most.
const SAMPLES: usize = 900;
/// Masks in memory at a time, at most.
const AT_ONCE: usize = 8;

/// All views in one frame.
pub struct Found {
    /// Photographs that carve.
    pub names: Vec<String>,
    pub views: Vec<View>,
    /// The first of them that shows the stone turned over.
    pub turned_from: usize,
    /// Photographs that do not carve.
    pub held_out: Vec<(String, View)>,
    /// How the second place of the stone was found: overlap, and residual [m].
    pub aligned: Option<[f64; 2]>,
    /// The turntable that --adjust has found.
    pub adjusted: Option<Adjusted>,
}

/// A turntable that silhouettes have changed, and what is said of it.
pub struct Adjusted {
    pub table: Turntable,
    pub words: String,
}

/// Names of the photographs of a folder, sorted.
pub fn names(folder: &Path) -> anyhow::Result<Vec<String>> {
    let found = photograph::in_folder(folder)
        .with_context(|| format!("{}: cannot read the folder", folder.display()))?;
    let name = |path: PathBuf| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    match found.len() {
        0 => anyhow::bail!("{}: has no photograph (.jpg, .jpeg, .png)", folder.display()),
        _ => Ok(found.into_iter().map(name).collect()),
    }
}

/// A mask as a distance field, and the size of its photograph.
pub type Silhouette = (Field, [usize; 2]);

/// Reads masks and cameras; a stone that was turned over is laid back.
pub fn read(args: &Args, names: &[String]) -> anyhow::Result<Found> {
    match (&args.turntable, &args.poses) {
        (Some(file), _) => on_turntable::read(args, names, file),
        (None, Some(path)) => posed(args, names, path),
        (None, None) => Err(cli::usage("give --turntable or --poses")),
    }
}

/// Photographs that carve, and those that --hold-out leaves out, by name.
pub struct Parted<T> {
    pub carve: Vec<(String, T)>,
    pub held_out: Vec<(String, T)>,
}

impl<T> Parted<T> {
    /// Every Nth photograph is held out.
    pub fn new(args: &Args, all: Vec<(String, T)>) -> anyhow::Result<Parted<T>> {
        let (mut carve, mut held_out) = (Vec::new(), Vec::new());
        if let Some(every) = args.hold_out.filter(|every| all.len() < *every) {
            return Err(cli::usage(format!(
                "--hold-out: {every} is more than the {} photographs that have a mask{}: give a smaller number",
                all.len(),
                if args.turntable.is_some() { " before or after the stone was turned over" } else { "" }
            )));
        }
        for (k, named) in all.into_iter().enumerate() {
            let held = args.hold_out.is_some_and(|every| (k + 1) % every == 0);
            if held { &mut held_out } else { &mut carve }.push(named);
        }
        Ok(Parted { carve, held_out })
    }

    /// Something else of each photograph.
    pub fn map<U>(self, of: impl Fn(T) -> U) -> Parted<U> {
        let all = |named: Vec<(String, T)>| named.into_iter().map(|(name, one)| (name, of(one))).collect();
        Parted { carve: all(self.carve), held_out: all(self.held_out) }
    }
}

fn posed(args: &Args, names: &[String], path: &Path) -> anyhow::Result<Found> {
    let all = poses::read(path).with_context(|| path.display().to_string())?;
    if args.poses_size.is_some() && all.iter().all(|p| p.size.is_some()) {
        return Err(cli::usage("--poses-size: cameras.txt says the sizes: leave it out"));
    }
    let stem = |n: &str| Path::new(n).file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let pose = |name: &String| all.iter().find(|p| p.name == *name || stem(&p.name) == stem(name));
    let used: Vec<String> = names.iter().filter(|n| pose(n).is_some()).cloned().collect();
    if used.is_empty() {
        anyhow::bail!(
            "{}: has poses of {} …, but the photographs are called {} …",
            path.display(),
            all[0].name,
            names[0]
        );
    }
    if used.len() < names.len() {
        let other = names.iter().find(|n| pose(n).is_none()).map_or("", String::as_str);
        let without = geom::counted_as(names.len() - used.len(), "photograph", ["has", "have"]);
        cli::warn(&format!("{without} no pose, such as {other}"));
    }
    let mut all = Vec::new();
    for (name, silhouette) in used.iter().zip(silhouettes(args, &used)?) {
        let (Some((field, size)), Some(pose)) = (silhouette, pose(name)) else { continue };
        let camera = resized(&pose.camera, pose.size.or(args.poses_size).unwrap_or(size), size)
            .with_context(|| name.clone())?;
        all.push((name.clone(), View { camera, field: field.into() }));
    }
    let parted = Parted::new(args, all)?;
    let turned_from = parted.carve.len();
    let (names, views) = parted.carve.into_iter().unzip();
    Ok(Found { names, views, turned_from, held_out: parted.held_out, aligned: None, adjusted: None })
}

/// The camera for a picture of another size than it was made for.
pub fn resized(camera: &Camera, from: [usize; 2], to: [usize; 2]) -> anyhow::Result<Camera> {
    let factor = to[0] as f64 / from[0] as f64;
    if (to[1] as f64 - factor * from[1] as f64).abs() > 1.0 {
        anyhow::bail!(
            "its pose is for {} × {} pixels, and there are {} × {}: give masks and photographs of the same shape (not cropped or turned)",
            from[0],
            from[1],
            to[0],
            to[1]
        );
    }
    Ok(camera.resized(factor))
}

/// The masks of some photographs; none where a mask is missing or empty, which a warning says.
pub fn silhouettes(args: &Args, names: &[String]) -> anyhow::Result<Vec<Option<Silhouette>>> {
    let progress = cli::Progress::new("masks", names.len() as u64);
    let mut all = Vec::with_capacity(names.len());
    for some in names.chunks(AT_ONCE) {
        let read: Vec<anyhow::Result<Option<Silhouette>>> = some
            .par_iter()
            .map(|name| {
                let silhouette = silhouette(args, name);
                progress.add(1);
                silhouette
            })
            .collect();
        for silhouette in read {
            all.push(silhouette?);
        }
    }
    if all.iter().all(Option::is_none) {
        anyhow::bail!(
            "{}: has no mask of any photograph, such as {}: make them with stone-mask",
            args.masks.display(),
            mask_path(args, &names[0]).display()
        );
    }
    Ok(all)
}

fn mask_path(args: &Args, name: &str) -> PathBuf {
    args.masks.join(photograph::mask_name(Path::new(name)))
}

fn silhouette(args: &Args, name: &str) -> anyhow::Result<Option<Silhouette>> {
    let path = mask_path(args, name);
    if !path.is_file() {
        cli::warn(&format!("{name}: has no mask {}: it is left out", path.display()));
        return Ok(None);
    }
    let failed = || path.display().to_string();
    let bytes = stream::whole::file(&path).with_context(failed)?;
    let (width, height, values) = photograph::read_values(&bytes).with_context(failed)?;
    let mask = Mask::given(width, height, values);
    let on_frame = mask.on_frame();
    if on_frame > 0 {
        cli::warn(&format!(
            "{name}: the frame cuts the stone at {on_frame} pixels: what is beyond stays uncarved"
        ));
    }
    let field = Field::new(&mask, SAMPLES);
    if field.is_none() {
        cli::warn(&format!("{name}: its mask is empty: it is left out"));
    }
    Ok(field.map(|field| (field, [width, height])))
}

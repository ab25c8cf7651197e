//! Files for ParaView: one moment, or a series of them.

use crate::{args::Args, counts, inputs};
use anyhow::Context;
use cli::{Output, Report};
use view::{
    Moment, Series,
    vtk::{self, SeriesFolder},
};

/// One moment, in one file.
pub fn vtp(args: &Args, output: &Output) -> anyhow::Result<Report> {
    let mut moment = Moment::at(args.time);
    let seen = inputs::read_all(args, &mut moment)?;
    moment.settle()?;
    let data = vtk::moment(&moment.parts(), moment.surfaces(), moment.time())?;
    let mut out = output.open()?;
    data.write(&mut out).with_context(|| output.name())?;
    out.commit()?;
    let (size, grains) = (format!("{} points, {} triangles", data.len(), data.faces.len()), moment.grains());
    let summary = format!("{}: {size}{}", output.name(), counts::words(grains));
    let report = Report::new(summary).with("time_s", moment.time()).with("layers", seen);
    Ok(report.with_all(&counts::fields(grains)))
}

/// A folder of files, and the list that says which of them shows what at which time.
pub fn pvd(args: &Args, output: &Output) -> anyhow::Result<Report> {
    let path = output.path().context("a series needs a file and a folder: give -o NAME.pvd")?;
    let folder = cli::folder_removed_on_signal(|| SeriesFolder::beside(path), SeriesFolder::filling)?;
    let mut series = Series::new(args.span(), folder.keeper());
    let seen = inputs::read_all(args, &mut series)?;
    let times = match series.times() {
        times if times.is_empty() => vec![0.0],
        times => times,
    };
    let entries = folder.entries(&series, &times)?;
    let mut out = output.open_text()?;
    vtk::write_collection(&entries, &mut out).with_context(|| output.name())?;
    let files = folder.commit()?;
    out.commit()?;
    let summary = format!("{}: {} moments in {files} files", output.name(), times.len());
    Ok(Report::new(summary).with("moments", times.len()).with("files", files).with("layers", seen))
}

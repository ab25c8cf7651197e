//! The head of a deck: units, box, and the atoms, from the data file or from a state.

use crate::arrival::Arrival;
use crate::clumps;
use crate::deck::Source;
use crate::files::{BODIES, BONDS, DATA, OF_BODIES};
use record::name::lammps_comment;
use std::path::Path;

pub fn commands(Source { scene, setup, schedule, arrivals, bonds, .. }: &Source) -> String {
    let edge = |periodic: &Option<(f64, f64)>| if periodic.is_some() { "p" } else { "m" };
    let [x, y, z] = [0, 1, 2].map(|axis| edge(&setup.periodic[axis]));
    let name = Path::new(&scene.text.name).file_name().unwrap_or_default().to_string_lossy().into_owned();
    let smallest = setup.particles.iter().map(|p| p.radius).fold(f64::INFINITY, f64::min);
    // A property has to be there before the data are read, and after a state is.
    let way = format!(" \"fix way all property/atom {}\"", Arrival::NAMES);
    let (way, with_way) = if arrivals.is_empty() { (String::new(), "") } else { (way, " fix way NULL Way") };
    let rigid = clumps::any(setup);
    let (number, with_number) = match rigid {
        true => (" \"fix number all property/atom mol ghost yes\"", " fix number NULL Molecules"),
        false => ("", ""),
    };
    let (fresh, resumed) = match rigid {
        true => (
            format!(" \"variable bodies index {BODIES}\""),
            format!(" \"variable bodies string ${{state}}{OF_BODIES}\""),
        ),
        false => (String::new(), String::new()),
    };
    // A state has its bonds with it.
    let (atoms, style) =
        if bonds.any() { ("bpm/sphere", format!(" \"include {BONDS}\"")) } else { ("sphere", String::new()) };
    let fresh = format!("{way}{number} \"read_data {DATA}{with_number}{with_way}\"{style}{fresh}");
    let resumed = format!(" \"read_restart ${{state}}\"{way}{number}{resumed}");
    let reach = match rigid || bonds.any() {
        true => format!(" cutoff {:?}\natom_modify map hash", clumps::extent(setup).max(bonds.extent())),
        false => String::new(),
    };
    let skin = setup.skin.unwrap_or(0.4 * smallest);
    format!(
        "# {}, written by dem-lammps: SI units; forces are sampled at instants.\n\
         units si\natom_style {atoms}\nboundary {x} {y} {z}\nnewton off\ncomm_modify vel yes{reach}\n\
         variable state index none # or a state that was kept, to go on from it\n\
         if \"${{state}} == none\" then{fresh} \"variable first index yes\" else{resumed} \"variable first index no\"\n\
         neighbor {skin:?} bin\nneigh_modify delay 0 every 1 check yes\ntimestep {:?}\n\
         variable t equal step*dt\n\n# contacts: overlap, dashpot, friction\npair_style granular\n",
        lammps_comment(&name),
        schedule.dt
    )
}

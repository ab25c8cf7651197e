//! The deck: the input script of a run, readable, and its data file.

use crate::arrival::Arrival;
use crate::batch;
use crate::bonds::Bonds;
use crate::clumps;
use crate::data;
use crate::error::Refusal;
use crate::error::{LammpsError, Result};
use crate::files::{BATCH, BODIES, BONDS, DATA, DUMPS, FINISHED, FRAMES, INPUT, OF_BONDS, STATES, TOUCHES};
use crate::head;
use crate::law::{Target, coefficients};
use crate::loads::Asked;
use crate::outlet;
use crate::refusal::Allowed;
use crate::types::{Types, law};
use crate::wall;
use dem::setup::Setup;
use geom::Vec3;
use record::name::lammps_comment;
use run::Schedule;
use scene::Scene;
use std::fmt::Write as _;
use std::fs::File;
use std::io::{BufReader, BufWriter, Read, Write};
use std::path::Path;

/// States of a run, where the scene has no `output.checkpoint`.
const KEPT: f64 = 20.0;

/// What a deck is made from.
#[derive(Clone, Copy)]
pub struct Source<'a> {
    pub scene: &'a Scene,
    /// Its setup, with all grains that come in.
    pub setup: &'a Setup,
    /// Those that come in.
    pub arrivals: &'a [Arrival],
    pub bonds: &'a Bonds,
    /// Which steps are frames.
    pub schedule: &'a Schedule,
    /// What was looked at, for which version.
    pub allowed: &'a Allowed,
    /// MPI ranks.
    pub ranks: usize,
}

/// A run for LAMMPS.
#[derive(Debug, Clone, PartialEq)]
pub struct Deck {
    /// The input script.
    pub input: String,
    /// The batch script.
    pub batch: String,
    /// What was replaced by the nearest that LAMMPS can do.
    pub bent: Vec<Refusal>,
    /// What of contacts it dumps.
    pub asked: Asked,
    types: Types,
    rigid: bool,
    /// What the velocity of clumps must be higher by at the start [m/s].
    kick: Vec3,
    /// Grains that come in, by their ids.
    arrivals: Vec<Arrival>,
    bonds: Bonds,
}

impl Deck {
    /// The deck of a source.
    ///
    /// # Errors
    /// Laws and particles that LAMMPS cannot have.
    pub fn of(from: Source) -> Result<Deck> {
        let Source { scene, setup, arrivals, allowed: Allowed { target, bent }, .. } = from;
        let (target, mut bent) = (*target, bent.clone());
        let mut refused: Vec<Refusal> = particles(setup).into_iter().collect();
        let types = Types::of(setup).unwrap_or_else(|refusal| {
            if target.nearest { &mut bent } else { &mut refused }.push(refusal);
            Types::of_means(setup)
        });
        let mut keep = |made: Result<String, Vec<Refusal>>| {
            made.unwrap_or_else(|more| {
                refused.extend(more);
                String::new()
            })
        };
        let pairs = keep(pairs(setup, &types, target, &mut bent));
        let asked = Asked::of(&scene.keys, setup, &types);
        let walls = keep(wall::commands(setup, &types, (target, asked.has(TOUCHES)), &mut bent));
        for list in [&mut refused, &mut bent] {
            let mut seen = Vec::new();
            list.retain(|one| {
                !seen.contains(one) && {
                    seen.push(one.clone());
                    true
                }
            });
        }
        if !refused.is_empty() {
            return Err(LammpsError::Cannot(refused));
        }
        // After all other forces.
        let way = if arrivals.is_empty() { String::new() } else { Arrival::commands(&setup.gravity) };
        let input = [
            head::commands(&from),
            pairs,
            groups(&types, setup),
            motion(&from),
            walls,
            way,
            outlet::commands(setup),
            tail(scene, from.schedule, &asked, clumps::any(setup)),
        ]
        .concat();
        let rigid = clumps::any(setup);
        let missing =
            if target.version.starts_clumps_without_gravity() { 0.5 * from.schedule.dt } else { 0.0 };
        let kick = setup.gravity * missing;
        let (batch, arrivals) = (batch::slurm(&scene.text.name, from.ranks, rigid), arrivals.to_vec());
        Ok(Deck { input, batch, bent, asked, types, rigid, kick, arrivals, bonds: from.bonds.clone() })
    }

    /// Its files that the input script reads.
    pub fn files(&self) -> Vec<&'static str> {
        let some = [(DATA, true), (BONDS, self.bonds.any()), (BODIES, self.rigid)];
        some.into_iter().filter(|(_, is_there)| *is_there).map(|(name, _)| name).collect()
    }

    /// Writes what one of them holds.
    fn put(&self, name: &str, setup: &Setup, out: &mut impl Write) -> std::io::Result<()> {
        match name {
            BONDS => self.bonds.commands(out),
            BODIES => clumps::write(setup, &self.kick, out),
            _ => data::write(setup, &self.types, (&self.arrivals, &self.bonds), out),
        }
    }

    /// The first of them that is another one in a folder.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn differs(&self, setup: &Setup, folder: &Path) -> std::io::Result<Option<&'static str>> {
        for name in self.files() {
            let open = File::open(folder.join(name));
            let open = open.map_err(|e| std::io::Error::new(e.kind(), format!("{name}: {e}")))?;
            let mut same = Same::new(BufReader::new(open));
            self.put(name, setup, &mut same)?;
            if !same.ends()? {
                return Ok(Some(name));
            }
        }
        Ok(None)
    }

    pub fn bonds(&self) -> &Bonds {
        &self.bonds
    }

    /// Whether it has rigid bodies.
    pub fn is_rigid(&self) -> bool {
        self.rigid
    }

    /// Writes the deck into a folder, which is made where it is missing.
    ///
    /// # Errors
    /// A folder that cannot be written to.
    pub fn write(&self, setup: &Setup, folder: &Path) -> Result<()> {
        let write = || {
            std::fs::create_dir_all(folder)?;
            for name in self.files() {
                let mut out = BufWriter::with_capacity(1 << 20, File::create(folder.join(name))?);
                self.put(name, setup, &mut out)?;
                out.flush()?;
            }
            std::fs::write(folder.join(BATCH), &self.batch)?;
            // A folder with an input script has all of the deck.
            let part = folder.join(format!("{INPUT}.part"));
            std::fs::write(&part, &self.input)?;
            std::fs::rename(part, folder.join(INPUT))
        };
        write().map_err(|error| LammpsError::Deck { folder: folder.display().to_string(), error })
    }
}

/// What is written, compared with a file.
struct Same<R> {
    file: R,
    equal: bool,
}

impl<R: Read> Same<R> {
    fn new(file: R) -> Same<R> {
        Same { file, equal: true }
    }

    /// Whether the file was all that was written.
    fn ends(mut self) -> std::io::Result<bool> {
        Ok(self.equal && self.file.read(&mut [0])? == 0)
    }
}

impl<R: Read> Write for Same<R> {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let mut there = vec![0; bytes.len()];
        self.equal = self.equal && self.file.read_exact(&mut there).is_ok() && there == bytes;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// Particles that LAMMPS cannot number, or none.
fn particles(setup: &Setup) -> Option<Refusal> {
    let highest = data::highest_number(setup);
    if setup.particles.is_empty() {
        return Some(Refusal::new("particles", "there is none", "add a [[fill]]"));
    }
    let why = format!("ids go up to {highest}, and LAMMPS numbers atoms up to {}", data::MOST_ATOMS);
    (highest > data::MOST_ATOMS).then(|| Refusal::new("particles", why, "give smaller ids (first_id)"))
}

/// Coefficients of each pair of types that can meet.
fn pairs(
    setup: &Setup,
    types: &Types,
    target: Target,
    bent: &mut Vec<Refusal>,
) -> Result<String, Vec<Refusal>> {
    let (mut lines, mut refused) = (Vec::new(), Vec::new());
    let all: Vec<_> = (1..).zip(&types.0).collect();
    for (i, a) in &all {
        for (j, b) in all.iter().filter(|(j, _)| j >= i) {
            let grains = [a, b].iter().any(|t| t.kind == crate::types::Kind::Grain);
            let Some(law) = law(setup, a.material, b.material).filter(|_| grains) else { continue };
            let elastic = wall::elastic(setup, a.material, b.material);
            let names = [a, b].map(|t| &setup.materials[t.material as usize].name[..]);
            match coefficients(law, elastic, Types::meeting(setup, [a, b]), target, bent) {
                Ok(words) => lines.push((format!("{i} {j}"), words, lammps_comment(&names.join("–")))),
                Err(refusal) => refused.push(refusal),
            }
        }
    }
    if !refused.is_empty() {
        return Err(refused);
    }
    let none = "hooke 1 0 damping velocity tangential linear_nohistory 0 0".to_owned();
    let first = lines.first().map_or(none, |line| line.1.clone());
    let mut text = format!("pair_coeff * * {first} # also pairs that never meet\n");
    for (pair, words, names) in lines {
        let _ = writeln!(text, "pair_coeff {pair} {words} # {names}");
    }
    Ok(text)
}

fn groups(types: &Types, setup: &Setup) -> String {
    let numbers: Vec<String> = types.grains().map(|(n, _)| n.to_string()).collect();
    let mut text = format!("\ngroup grains type {}\n", numbers.join(" "));
    numbers.iter().for_each(|n| text += &format!("group type{n} type {n}\n"));
    if clumps::any(setup) {
        text += "group bodies molecule > 0\ngroup loose subtract grains bodies\n";
        text += &clumps::commands(setup);
    }
    text
}

fn motion(Source { setup, arrivals, bonds, .. }: &Source) -> String {
    let loose = if clumps::any(setup) { "loose" } else { "grains" };
    let style = if bonds.any() { "nve/bpm/sphere" } else { "nve/sphere" };
    let (g, size) = (setup.gravity, setup.gravity.norm());
    let gravity = match size > 0.0 {
        true => format!("fix gravity {loose} gravity {size:?} vector {:?} {:?} {:?}\n", g.x, g.y, g.z),
        false => String::new(),
    };
    if arrivals.is_empty() {
        return format!("fix move {loose} {style}\n{gravity}");
    }
    format!(
        "\n# grains that come in feel nothing until they are free\n\
         compute way {loose} property/atom {}\n\
         variable waits atom \"step*dt<c_way[1]\"\nvariable moves atom \"step*dt>=c_way[1]\"\n\
         group waiting dynamic {loose} var waits every 1\ngroup free dynamic {loose} var moves every 1\n\
         fix come waiting nve\nfix move free {style}\n{gravity}",
        Arrival::NAMES
    )
}

/// Output and the run: frame k is at the step nearest to k × `every`, the last step is one.
fn tail(scene: &Scene, schedule: &Schedule, asked: &Asked, rigid: bool) -> String {
    let Schedule { dt, last, every, .. } = schedule;
    let report = (last / 200).max(1);
    // A temperature would need more degrees of freedom than two bodies have. Wall spheres are heavy: the energy of those that move would hide all other.
    let (energy, column) = match rigid {
        true => ("", "atoms"),
        false => ("compute energy grains ke\n", "c_energy"),
    };
    let keep = scene.keys.output.checkpoint.map_or(*last as f64 / KEPT, |s| s / dt).clamp(1.0, *last as f64);
    let (keep, [a, b], loads, columns) = (keep.round(), STATES, asked.commands(), asked.of_frames());
    let stems = DUMPS.iter().filter(|dump| asked.has(dump)).map(|dump| dump.trim_end_matches(".dump"));
    let parts: String = stems.map(|dump| format!(" -var {dump} {dump}-2.dump")).collect();
    let turned = match asked.has(OF_BONDS) {
        true => "compute turned grains property/atom quatw quati quatj quatk\n",
        false => "",
    };
    format!(
        "\n# frames\nvariable frames index {FRAMES}\n\
         variable due equal \"round((round(step*{dt:?}/{every:?})+1)*{every:?}/{dt:?})\"\n\
         variable next equal \"(v_due<{last} || step>={last})*v_due+(v_due>={last} && step<{last})*{last}\"\n\
         {turned}dump frames grains custom 1 ${{frames}} {columns}\n\
         dump_modify frames every v_next first ${{first}} flush yes format float %.17g\n\
         {loads}\n\
         {energy}thermo {report}\nthermo_style custom step {column}\nthermo_modify lost error flush yes\n\
         # states, in turn: lmp -in run.in -var state {a}{parts} goes on from one\n\
         variable keep index {keep}\nif \"${{state}} == {a}\" then \"variable states string '{b} {a}'\" else \"variable states string '{a} {b}'\"\n\
         if \"${{keep}} > 0\" then \"restart ${{keep}} ${{states}}\"\nrun {last} upto\n\
         print \"step {last}\" file {FINISHED}\n"
    )
}

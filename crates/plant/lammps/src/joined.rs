//! Bonds at each frame: which of them LAMMPS still has, and what they bear by their law at the positions and turns that it came to.
//!
//! ```text
//! bonds.dump     i j of each whole bond                compute property/local
//! ```
//!
//! A bond that is in one frame and not in the next has broken between them, and counts from the second: what it bore, and its energy, are those of the first.

use crate::dump::{self, Dump, Ended, Parts};
use crate::files::OF_BONDS;
use crate::instant::Now;
use crate::places::{nearest, number_of, wrapped};
use dem::setup::BondNumbers;
use dem::setup::bond::cluster_of;
use dem::{BondState, BreakMode, Crack, Pull};
use geom::Vec3;
use nalgebra::UnitQuaternion;
use std::collections::HashSet;

/// Columns of the dump.
const COLUMNS: &str = "c_joined[1] c_joined[2]";

/// The commands that write the dump; `how` is that of frames.
pub fn commands(how: &str) -> String {
    format!(
        "\n# bonds that are whole\ncompute joined all property/local batom1 batom2\nvariable bonds index {OF_BONDS}\n\
         dump bonds all local 1 ${{bonds}} {COLUMNS}\ndump_modify bonds {how}\n"
    )
}

/// Bonds from frame to frame.
pub struct Joined<'a> {
    dump: Option<Dump<'a>>,
    /// Those of the start, by ids.
    made: &'a [([u32; 2], BondNumbers)],
    /// What each bore when it was whole last, and when it broke [s].
    last: Vec<(Pull, Option<f64>)>,
}

impl<'a> Joined<'a> {
    /// Of bonds that were made, and the dump, if there is one.
    pub fn new(made: &'a [([u32; 2], BondNumbers)], dump: Option<Parts<'a>>) -> Joined<'a> {
        let dump = dump.map(|parts| Dump::new(parts, COLUMNS));
        Joined { dump, made, last: vec![(Pull::default(), None); made.len()] }
    }

    /// The bonds of a frame, and those that broke since the one before; `turns` are those of the particles since the start.
    ///
    /// # Errors
    /// A dump that ends, or is wrong.
    pub fn at(
        &mut self,
        now: &Now,
        turns: &[UnitQuaternion<f64>],
    ) -> Result<(Vec<BondState>, Vec<Crack>), Ended> {
        let Some(block) = dump::block(&mut self.dump, now.step)? else { return Ok(Default::default()) };
        let pair = |a: f64, b: f64| [a.min(b) as u64, a.max(b) as u64];
        let whole: HashSet<[u64; 2]> = block.rows().map(|row| pair(row[0], row[1])).collect();
        let (mut all, mut cracks) = (Vec::with_capacity(self.made.len()), Vec::new());
        for ((ids, bond), (pull, broken)) in self.made.iter().zip(&mut self.last) {
            let place = |id: u32| now.particles.binary_search_by_key(&id, |p| p.id);
            let [Ok(i), Ok(j)] = ids.map(place) else {
                return Err(Ended::Wrong(format!("bonds: a grain of {} and {} is missing", ids[0], ids[1])));
            };
            let ends = [&now.particles[i], &now.particles[j]];
            let arm = nearest(now.setup, ends[0].position - ends[1].position);
            let middle = wrapped(now.setup, ends[1].position + arm * 0.5).0;
            let bears = || {
                let velocity = ends[0].velocity - ends[1].velocity;
                dem::bond_now(bond, [arm, velocity], [ends[0].spin, ends[1].spin], [turns[i], turns[j]])
            };
            if whole.contains(&ids.map(number_of)) && broken.is_none() {
                *pull = bears();
            } else if broken.is_none() {
                // One that bore nothing before is judged by where its grains are now.
                let judged = if pull.stress[..2] == [0.0; 2] { bears() } else { *pull };
                pull.stress = judged.stress;
                *broken = Some(now.time);
                cracks.push(Crack {
                    time: now.time,
                    ids: *ids,
                    clusters: ids.map(|id| cluster_of(&now.setup.clusters, id)),
                    place: middle,
                    normal: arm.try_normalize(0.0).unwrap_or_else(Vec3::zeros),
                    radius: bond.size[1],
                    mode: mode(bond, pull),
                    energy: pull.elastic,
                });
            }
            all.push(state(*ids, middle, bond, pull, *broken));
        }
        Ok((all, cracks))
    }
}

/// Which of both strengths a load comes nearer to.
fn mode(bond: &BondNumbers, pull: &Pull) -> BreakMode {
    let [tension, shear] = bond.resists(pull.stress[2]);
    let nearer = pull.stress[0] / tension >= pull.stress[1] / shear;
    if tension.is_finite() && (nearer || shear.is_infinite()) { BreakMode::Tension } else { BreakMode::Shear }
}

fn state(ids: [u32; 2], middle: Vec3, bond: &BondNumbers, pull: &Pull, broken: Option<f64>) -> BondState {
    let (force, moments) = match broken {
        None => (pull.force.into(), pull.moment.map(Into::into)),
        Some(_) => (Vec3::zeros(), [Vec3::zeros(); 2]),
    };
    let [tension, shear, mean] = pull.stress;
    BondState {
        ids,
        middle,
        size: bond.size,
        broken,
        mode: mode(bond, pull),
        force,
        moments,
        stress: [tension, shear],
        strength: bond.resists(mean),
    }
}

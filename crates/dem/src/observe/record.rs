//! What contacts do at one instant, and the sliding work that they have done, for observers.

use crate::kernel::LEDGER;
use crate::model::Model;
use crate::model::kind::{Kind, With};
use crate::neighbours::NeighbourLists;
use crate::neighbours::contacts::Contacts;
use crate::neighbours::ends::{idles, partner};
use crate::space::sphere::FAR;
use crate::state::State;
use geom::Vec3;

/// Column of the ledger with what sliding dissipated in a step.
const SLIDING: usize = 2;

/// One contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactRecord {
    /// Where the two touch [m]; divides the distance of the centres as the radii do. The centre of i where it has left a mesh.
    pub point: Vec3,
    /// Unit normal from j to i; zero where i has left a mesh.
    pub normal: Vec3,
    /// Force on i [N].
    pub force: Vec3,
    /// Overlap [m]; negative where the two no longer touch.
    pub overlap: f64,
    /// Id of particle i.
    pub i: u32,
    /// Id of particle j, or the number of the wall.
    pub j: u32,
    /// Whether j is a wall.
    pub wall: bool,
    /// What sliding has dissipated in this contact since contacts were recorded last [J]; 0 without the ledger.
    pub work: f64,
}

impl Contacts {
    /// Adds the sliding work of one step; the ledger has been computed.
    pub fn add_work(&mut self) {
        let sliding = self.ledger.chunks_exact(LEDGER).map(|row| row[SLIDING]);
        self.work.iter_mut().zip(sliding).for_each(|(work, step)| *work += step);
    }
}

/// All contacts that carry a force, or have done work since the last call, in the order of the lists.
pub fn record_contacts(model: &Model, state: &State, lists: &mut NeighbourLists) -> Vec<ContactRecord> {
    let mut work = std::mem::take(&mut lists.contacts.work);
    let mut out = Vec::new();
    for segment in &lists.contacts.segments {
        let kind = &model.kinds[segment.kind];
        for place in segment.contacts() {
            // A particle that has left at the end of a zone is in the lists until the next rebuild.
            let (i, other) = lists.contacts.ends(kind.with, place);
            let gone = |k: u32| state.zones.is_gone(k as usize);
            if gone(i) || other.is_some_and(gone) || idles(state, lists, kind.with, place) {
                continue;
            }
            let force = lists.contacts.force(place);
            let done = work.get_mut(place).map_or(0.0, std::mem::take);
            if force != Vec3::zeros() || done != 0.0 {
                let (other, radius) =
                    partner(model, state, lists, segment, place, |k| state.particles.position(k));
                out.push(record(model, state, lists, kind, place, (other, radius), (force, done)));
            }
        }
    }
    lists.contacts.work = work;
    out
}

fn record(
    model: &Model,
    state: &State,
    lists: &NeighbourLists,
    kind: &Kind,
    place: usize,
    (other, radius): (Vec3, f64),
    (force, work): (Vec3, f64),
) -> ContactRecord {
    let i = lists.contacts.i[place] as usize;
    let (centre, mine) = (state.particles.position(i), state.particles.rows[i][3]);
    // A mesh that the particle has left since has no point that is nearest to it: the record has the particle's centre.
    let gone = other.x.abs() >= FAR[0][0];
    let apart = if gone { Vec3::zeros() } else { centre - other };
    let reach = mine + radius;
    let distance = if gone { 2.0 * reach } else { apart.norm() };
    let normal = apart.try_normalize(0.0).unwrap_or_else(Vec3::zeros);
    let (j, wall) = match kind.with {
        With::Wall(w) => (w as u32, true),
        _ => (state.particles.id[lists.contacts.partner[place] as usize], false),
    };
    let point = model.wrapped(centre - normal * (mine * distance / reach));
    ContactRecord { point, normal, force, overlap: reach - distance, i: state.particles.id[i], j, wall, work }
}

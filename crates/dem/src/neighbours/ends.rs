//! The two ends of a contact.

use crate::model::Model;
use crate::model::kind::With;
use crate::neighbours::NeighbourLists;
use crate::neighbours::contacts::Segment;
use crate::state::State;
use geom::Vec3;

/// Whether contact `place`, of those with these, acts on no particle ([`crate::state::zones::Zones::idles`]).
pub fn idles(state: &State, lists: &NeighbourLists, with: With, place: usize) -> bool {
    state.zones.idles(lists.contacts.ends(with, place))
}

/// Where the second of a contact is, and its radius [m] (0 on a flat wall); `position` tells where particles are.
pub fn partner(
    model: &Model,
    state: &State,
    lists: &NeighbourLists,
    segment: &Segment,
    place: usize,
    position: impl Fn(usize) -> Vec3,
) -> (Vec3, f64) {
    if model.kinds[segment.kind].with == With::Particles {
        let j = lists.contacts.partner[place] as usize;
        return (position(j), state.particles.rows[j][3]);
    }
    let row = lists.contacts.partner_row(segment, place);
    (Vec3::new(row[0], row[1], row[2]), row[3])
}

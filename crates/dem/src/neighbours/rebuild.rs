//! Rebuilds the lists: sorts the particles in space, and finds pairs and walls near them.

use crate::model::Model;
use crate::model::kind::With;
use crate::neighbours::NeighbourLists;
use crate::neighbours::contacts::Contacts;
use crate::neighbours::history::{recall, recall_work};
use crate::neighbours::list::List;
use crate::neighbours::poses::{around, periods_travelled, pose_listed, shift_into_box, wall_way};
use crate::setup::Zone;
use crate::space::search::{Pair, SKIN, Search, half_of_shifts, margin, pairs, tile};
use crate::state::ledger::wrap_in_ledger;
use crate::state::{ListStatus, State};
use crate::threads::share;
use crate::walls::images::Periods;
use geom::Vec3;
use std::collections::BTreeSet;
use std::ops::Range;

/// Particles below which one thread lists faster than several: handing over takes some ten microseconds.
pub const LISTED_FEW: usize = 256;

/// Which kind two materials belong to.
struct KindTable {
    materials: usize,
    at: Vec<usize>,
}

impl KindTable {
    fn of(&self, a: u16, b: u16) -> usize {
        self.at[a as usize * self.materials + b as usize]
    }
}

/// Sorts, lists, and remembers.
pub fn rebuild(model: &Model, state: &mut State, lists: &mut NeighbourLists) {
    // Lists that are stale for another reason say nothing of the skin.
    if model.setup.skin.is_none() && state.listing.status != ListStatus::Outdated {
        state.listing.skin = SKIN
            .next(state.listing.skin, state.steps - state.listing.step, model.mean_radius)
            .max(model.reach);
    }
    let wraps = wrap(model, state);
    let wall_periods = std::mem::take(&mut lists.wall_periods);
    state.servos.iter_mut().for_each(|p| p.listed = p.way);
    let mut before = std::mem::take(&mut lists.contacts);
    // Freed before anything is listed: old and new together would be the most that a run ever takes.
    before.release_memory();
    let remembers = !before.memory.is_empty() || !before.work.is_empty();
    if remembers && before.starts.is_empty() {
        before.index(&model.kinds);
    }
    let (search, order) = space_order(model, state);
    state.particles.select(&order);
    state.zones.reorder(&order);
    state.bodies.reorder(&order);
    state.bonds.reorder(&order, &state.particles.id);
    if let Some(sleepers) = &mut state.sleepers {
        sleepers.select(&order);
    }
    follow_starting(state, &order);
    state.listing.step = state.steps;
    list_contacts(model, state, lists, &search);
    let moved = (&wraps[..], &wall_periods[..]);
    recall(model, state, lists, &before, &order, moved);
    recall_work(model, lists, &before, &order, moved);
    drop(before);
    allocate(model, state, lists);
    state.listing.status = ListStatus::Valid;
    state.listing.rebuilds += 1;
}

fn follow_starting(state: &mut State, order: &[u32]) {
    if state.starting.is_empty() {
        return;
    }
    let mut is_starting = vec![false; order.iter().max().map_or(0, |&last| last as usize + 1)];
    for &k in &state.starting {
        if let Some(flag) = is_starting.get_mut(k as usize) {
            *flag = true;
        }
    }
    state.starting =
        (0..).zip(order).filter(|&(_, &was)| is_starting[was as usize]).map(|(now, _)| now).collect();
}

/// Particles that have left the box through a periodic face come back through the other. Returns by how many periods each
/// was moved; none where nothing is periodic.
fn wrap(model: &Model, state: &mut State) -> Vec<Periods> {
    if model.setup.periodic.iter().all(|p| p.is_none()) {
        return Vec::new();
    }
    let before: Vec<Vec3> = (0..state.particles.len()).map(|k| state.particles.position(k)).collect();
    wrap_in_ledger(model, state, |state| {
        for k in (0..state.particles.len()).filter(|&k| !state.bodies.is_member(k)) {
            let p = model.wrapped(state.particles.position(k));
            state.particles.rows[k][..3].copy_from_slice(p.as_slice());
        }
        state.bodies.wrap(&mut state.particles, &model.setup.periodic);
    });
    let period = model.period();
    let whole = |by: f64, period: f64| if period > 0.0 { (by / period).round() as i32 } else { 0 };
    let moved = |(k, was): (usize, Vec3)| {
        let by = state.particles.position(k) - was;
        [0, 1, 2].map(|a| whole(by[a], period[a]))
    };
    before.into_iter().enumerate().map(moved).collect()
}

/// Gives each particle that stays its home and its room there, and sorts them.
fn space_order(model: &Model, state: &mut State) -> (Search, Vec<u32>) {
    let (horizon, gravity) = (model.horizon * model.dt, model.setup.gravity.norm());
    let p = &mut state.particles;
    let stay: Vec<u32> = (0..p.len() as u32).filter(|&k| !state.zones.is_gone(k as usize)).collect();
    for &k in &stay {
        let row = &p.rows[k as usize];
        let speed = Vec3::new(row[4], row[5], row[6]).norm();
        let way = horizon * (speed + 0.5 * gravity * horizon);
        let margin = margin(state.listing.skin, way, model.mean_radius);
        p.home[k as usize].0 = [row[0], row[1], row[2], margin];
    }
    let points: Vec<Vec3> = stay.iter().map(|&k| p.position(k as usize)).collect();
    let reach: Vec<f64> = stay.iter().map(|&k| p.reach(k as usize)).collect();
    let search = Search::new(&points, &reach);
    let order = search.order().iter().map(|&k| stay[k as usize]).collect();
    (search, order)
}

/// Lists all contacts of the particles where they were listed: a function of those positions and margins, of the step of
/// listing, and of nothing else, so that a resumed run has the same lists.
pub fn list_again(model: &Model, state: &mut State, lists: &mut NeighbourLists) {
    // Particles that have left since were still there when neighbours were listed.
    for (k, home) in state.zones.left.clone() {
        state.particles.home[k as usize] = home;
    }
    let p = &state.particles;
    let points: Vec<Vec3> = p.home.iter().map(|h| Vec3::new(h[0], h[1], h[2])).collect();
    let reach: Vec<f64> = (0..p.len()).map(|k| p.reach(k)).collect();
    list_contacts(model, state, lists, &Search::new(&points, &reach));
    allocate(model, state, lists);
    for (k, _) in state.zones.left.clone() {
        let row = state.particles.rows[k as usize];
        state.particles.home[k as usize].0 = [row[0], row[1], row[2], 0.0];
    }
}

fn list_contacts(model: &Model, state: &mut State, lists: &mut NeighbourLists, search: &Search) {
    lists.wall_periods = periods_travelled(model, state);
    let count = state.particles.len();
    let wide = search.wide_pairs();
    let class = classes(model, With::Particles);
    let tile = tile(count);
    let tiles = share(count >= LISTED_FEW, (0..count.div_ceil(tile)).collect(), |t| {
        let range = t * tile..((t + 1) * tile).min(count);
        let mut found = vec![<[List; 2]>::default(); model.kinds.len()];
        let material = |k: u32| state.particles.material[k as usize];
        let mut pairs = pairs(search, &wide, &range);
        state.bodies.drop_own(&mut pairs, |p| *p);
        // Those that touch go first: a block of others is passed over as long as none of them comes to touch.
        let (touching, apart): (Vec<_>, Vec<_>) = pairs.into_iter().partition(|p| touch(state, p));
        for (i, j) in touching.into_iter().chain(apart) {
            found[class.of(material(i), material(j))][usize::from(j as usize >= range.end)].push(i, j);
        }
        list_walls(model, state, lists, range, &mut found);
        found
    });
    lists.contacts =
        Contacts::new(&model.kinds, &list_images(model, state, search), &tiles, (count, model.form()));
    if state.sleepers.is_some() || !state.zones.none() {
        lists.contacts.index(&model.kinds);
    }
    note_near(state);
    if state.sleepers.is_some() {
        lists.contacts.mark_wall_blocks(&model.kinds, &model.walls);
        lists.contacts.find_adjacent_tiles(&model.kinds);
    }
}

/// Whether two particles touched where they were listed.
fn touch(state: &State, &(i, j): &Pair) -> bool {
    let p = &state.particles;
    let [a, b] = [i, j].map(|k| (&p.home[k as usize], p.rows[k as usize][3]));
    let square: f64 = (0..3).map(|x| (a.0[x] - b.0[x]) * (a.0[x] - b.0[x])).sum();
    let reach = a.1 + b.1;
    square < reach * reach
}

fn list_walls(
    model: &Model,
    state: &State,
    lists: &NeighbourLists,
    range: Range<usize>,
    found: &mut [[List; 2]],
) {
    for (kind, [list, _]) in model.kinds.iter().zip(found) {
        let With::Wall(w) = kind.with else { continue };
        let wall = &model.walls[w];
        let (pose, moves) =
            (shift_into_box(model, lists, w, pose_listed(model, state, w)), wall_margin(model, state, w));
        let around = around(model, w, &pose);
        for k in range.clone().filter(|&k| state.particles.material[k] == kind.between.0) {
            let home = &state.particles.home[k];
            let (place, reach) = (Vec3::new(home[0], home[1], home[2]), state.particles.reach(k) + moves);
            for (image, shift) in around.near(&place, reach) {
                let first = image.0 * wall.parts();
                let add = |part| list.push(k as u32, first + part);
                wall.parts_near(pose.home(&(place - shift)), reach, image.0 > 0, add);
            }
        }
    }
}

/// How far a wall may move until lists are rebuilt [m].
pub fn wall_margin(model: &Model, state: &State, wall: usize) -> f64 {
    margin(state.listing.skin, model.horizon * model.dt * model.walls[wall].fastest(), model.mean_radius)
}

/// Pairs across periodic faces: each once, by the half of all shifts whose first part that is not zero is positive.
fn list_images(model: &Model, state: &State, search: &Search) -> Vec<List> {
    let mut found = Vec::new();
    for shift in half_of_shifts(&model.setup.periodic) {
        search.shifted_pairs(&shift, &mut found);
    }
    state.bodies.drop_own(&mut found, |f| (f.0, f.1));
    found.sort_by_key(|f| (f.0, f.1));
    let class = classes(model, With::Images);
    let mut lists = vec![List::default(); model.kinds.len()];
    let material = |k: u32| state.particles.material[k as usize];
    for (i, j, shift) in found {
        let list = &mut lists[class.of(material(i), material(j))];
        list.push(i, j);
        list.shift.push(shift);
    }
    lists
}

/// Room for the loads of all listed contacts; made last, when old lists are gone.
pub fn allocate(model: &Model, state: &mut State, lists: &mut NeighbourLists) {
    let torques = state.torques(model);
    lists.contacts.allocate(torques, model.setup.ledger);
    lists.contacts.keep_wrenches(state.keeps_wrenches());
}

fn classes(model: &Model, with: With) -> KindTable {
    let materials = model.setup.materials.len();
    let mut at = vec![usize::MAX; materials * materials];
    for (k, i) in model.kinds.iter().enumerate().filter(|(_, i)| i.with == with) {
        let (a, b) = (i.between.0 as usize, i.between.1 as usize);
        at[a * materials + b] = k;
        at[b * materials + a] = k;
    }
    KindTable { materials, at }
}

/// Whether lists must be rebuilt: they are outdated, or a particle or a wall may have left its margin.
pub fn is_due(model: &Model, state: &State) -> bool {
    let since = (state.steps - state.listing.step) as f64 * model.dt;
    // Written so that NaN is caught.
    let holds = |w: usize| wall_way(model, state, w, since) <= wall_margin(model, state, w);
    state.listing.status != ListStatus::Valid || !(0..model.walls.len()).all(holds)
}

/// Notes which particles may pass a storage plane, or come back through it, before the next rebuild: the margins of no others reach it. Where what is tested
/// is the centre of a clump, rooms of its members say nothing.
fn note_near(state: &mut State) {
    let p = &state.particles;
    let near = |(zone, beyond): (&Zone, &BTreeSet<u32>)| {
        let stays = |k: usize| {
            let (home, margin) = (Vec3::new(p.home[k][0], p.home[k][1], p.home[k][2]), p.home[k][3]);
            let past = zone.past(&home, p.rows[k][3]);
            !state.bodies.is_member(k) && (past < -margin || (past > margin && beyond.contains(&p.id[k])))
        };
        (0..p.len() as u32).filter(|&k| !stays(k as usize)).collect()
    };
    state.zones.near = state.zones.outlets.iter().zip(&state.zones.beyond).map(near).collect();
}

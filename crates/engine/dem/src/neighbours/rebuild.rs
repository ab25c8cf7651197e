//! Rebuilds the lists: sorts the particles in space, and finds pairs and walls near them.

use crate::model::{Model, With};
use crate::neighbours::contact_records;
use crate::neighbours::history::carry_over;
use crate::neighbours::poses::{around, periods_travelled, pose_listed, shift_into_box, wall_shift};
use crate::neighbours::{List, NeighbourLists, OldContacts, Slots, StepColumns};
use crate::setup::Zone;
use crate::space::search::{ImagePair, Pair, Search, next_skin, pairs, tile};
use crate::state::ledger::wrap_in_ledger;
use crate::state::{ContactColumns, ListStatus, State, WrenchColumns};
use crate::threads::{change, each, share};
use geom::Vec3;
use laws::simd::{Aligned, Row4};
use laws::space::images::Periods;
use laws::space::margins::{MarginInputs, margin, touched};
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

/// Sorts particles, lists contacts, and carries their history over.
pub fn rebuild(model: &Model, state: &mut State, lists: &mut NeighbourLists) {
    let worked = contact_records::with_work(model, state, lists);
    adapt_skin(model, state);
    let wraps = wrap(model, state);
    let wall_periods = std::mem::take(&mut lists.wall_periods);
    state.servos.iter_mut().for_each(|p| p.listed = p.shift);
    state.mounts.iter_mut().for_each(|p| p.listed = p.shift);
    let (mut slots, mut columns) = (std::mem::take(&mut lists.slots), std::mem::take(&mut state.contacts));
    // Freed before anything is listed: old and new together would be the most memory that a run ever takes.
    lists.step = StepColumns::default();
    columns.release();
    let carries = !columns.history.is_empty() || !columns.work.is_empty() || !columns.touched.is_empty();
    if carries && slots.starts.is_empty() {
        slots.index();
    }
    let (search, order) = space_order(model, state);
    state.reorder(&order, &mut lists.spare);
    state.listing.step = state.steps;
    if let Some(cell) = &mut state.strained {
        cell.list(margin(state.listing.skin, model.horizon * model.dt * cell.fastest(), model.mean_radius));
    }
    list_contacts(model, state, lists, search);
    let old = OldContacts { slots, columns, order, wraps, wall_periods };
    let carried = carry_over(model, state, lists, &old);
    state.ended.extend(worked.into_iter().filter(|(slot, _)| !carried[*slot]).map(|(_, record)| record));
    drop(old);
    allocate(model, state, lists);
    state.listing.status = ListStatus::Valid;
    state.listing.rebuilds += 1;
}

/// Wider or narrower lists, by how long the last ones held.
pub fn adapt_skin(model: &Model, state: &mut State) {
    // Lists that are outdated for another reason say nothing of the skin.
    if model.setup.skin.is_none() && state.listing.status != ListStatus::Outdated {
        let held = state.steps - state.listing.step;
        state.listing.skin = next_skin(state.listing.skin, held, model.mean_radius).max(model.reach);
    }
}

/// Particles that have left the box through a periodic face come back through the other. Returns by how many periods each
/// was moved; none where nothing is periodic.
fn wrap(model: &Model, state: &mut State) -> Vec<Periods> {
    if model.setup.periodic.iter().all(|p| p.is_none()) {
        return Vec::new();
    }
    let count = state.particles.len();
    let before = each(count, |k| state.particles.position(k));
    let cell = state.cell(model);
    wrap_in_ledger(model, state, |state| {
        let mut work = 0.0;
        let State { particles, clumps, .. } = &mut *state;
        change(&mut particles.rows[..count], |k, row| {
            if !clumps.is_member(k) {
                row[..3].copy_from_slice(cell.wrapped(before[k]).as_slice());
            }
        });
        if cell.moves() {
            for k in (0..count).filter(|&k| !clumps.is_member(k)) {
                let by = -cell.away(&before[k]).component_mul(&cell.speed);
                work += particles.kick(k, &by, model.dt);
            }
        }
        work += state.clumps.wrap(&mut state.particles, &cell, model.dt);
        state.ledger.move_by_walls(work);
    });
    let period = cell.lengths();
    let whole = |by: f64, period: f64| if period > 0.0 { (by / period).round() as i32 } else { 0 };
    each(count, |k| {
        let by = state.particles.position(k) - before[k];
        [0, 1, 2].map(|a| whole(by[a], period[a]))
    })
}

/// What the margins of particles are made of that are listed now.
pub fn margins(model: &Model, state: &State) -> MarginInputs {
    MarginInputs {
        skin: state.listing.skin,
        horizon: model.horizon * model.dt,
        gravity: model.setup.gravity.norm(),
        most: model.mean_radius,
        ahead: model.ahead(),
    }
}

/// Largest margin [m]: the search needs numbers, also where a speed is none; such a particle trips the guard of motion.
const WIDEST: f64 = 1e74;

/// Notes the position and the margin of each particle that stays, and sorts them.
fn space_order(model: &Model, state: &mut State) -> (Search, Vec<u32>) {
    let margins = margins(model, state);
    let State { particles: p, zones, .. } = state;
    let rows = &p.rows;
    change(&mut p.home, |k, home| {
        if zones.is_gone(k) {
            return;
        }
        let row = &rows[k];
        *home = Row4([row[0], row[1], row[2], margins.of(&row.velocity()).min(WIDEST)]);
    });
    let stay: Vec<u32> = (0..p.len() as u32).filter(|&k| !zones.is_gone(k as usize)).collect();
    let points = each(stay.len(), |n| p.position(stay[n] as usize));
    let reach = each(stay.len(), |n| p.reach(stay[n] as usize));
    let search = Search::new(&points, &reach);
    let order = each(stay.len(), |n| stay[search.order()[n] as usize]);
    (search, order)
}

/// Lists all contacts of the particles where they were listed: a function of those positions and margins, of the step of
/// listing, and of nothing else, so that a resumed run has the same lists.
pub fn restore_lists(model: &Model, state: &mut State, lists: &mut NeighbourLists) {
    // Particles that have left since were still there when neighbours were listed.
    for (k, home) in state.zones.left.clone() {
        state.particles.home[k as usize] = home;
    }
    let p = &state.particles;
    let points: Vec<Vec3> = p.home.iter().map(Row4::vector).collect();
    let reach: Vec<f64> = (0..p.len()).map(|k| p.reach(k)).collect();
    list_contacts(model, state, lists, Search::new(&points, &reach));
    allocate(model, state, lists);
    for (k, _) in state.zones.left.clone() {
        let row = state.particles.rows[k as usize];
        state.particles.home[k as usize] = Row4::of(row.position());
    }
}

fn list_contacts(model: &Model, state: &mut State, lists: &mut NeighbourLists, search: Search) {
    lists.wall_periods = periods_travelled(model, state);
    let count = state.particles.len();
    let wide = search.wide_pairs();
    let class = classes(model, With::Particles);
    let tile = tile(count);
    let tiles = share(count >= LISTED_FEW, (0..count.div_ceil(tile)).collect(), |t| {
        let range = t * tile..((t + 1) * tile).min(count);
        let mut found = vec![<[List; 2]>::default(); model.kinds.len()];
        let material = |k: u32| state.particles.material[k as usize];
        let mut pairs = pairs(&search, &wide, &range);
        state.clumps.drop_own(&mut pairs, |p| *p);
        state.bonds.drop_replaced(&mut pairs, |p| *p);
        // Those that touch go first: a block of others is passed over as long as none of them comes to touch.
        let (touching, apart): (Vec<_>, Vec<_>) = pairs.into_iter().partition(|p| touch(state, p));
        for (i, j) in touching.into_iter().chain(apart) {
            found[class.of(material(i), material(j))][usize::from(j as usize >= range.end)].push(i, j);
        }
        list_walls(model, state, lists, range, &mut found);
        found
    });
    let images = list_images(model, state, &search);
    drop(search);
    put(model, state, lists, Slots::new(&model.kinds, images, tiles, count, model.layout()));
}

/// Takes lists that a device has made, for the particles where they were listed; their contacts have no history yet.
pub fn take_lists(model: &Model, state: &mut State, lists: &mut NeighbourLists, slots: Slots) {
    put(model, state, lists, slots);
    allocate(model, state, lists);
}

/// Puts lists in place, with columns for their contacts.
fn put(model: &Model, state: &mut State, lists: &mut NeighbourLists, slots: Slots) {
    lists.slots = slots;
    lists.step = StepColumns::new(&lists.slots, model.kinds.iter().any(|k| k.composition.rotates()));
    let history = Aligned::zeros(lists.slots.history);
    state.contacts = ContactColumns { layout: model.layout(), history, ..ContactColumns::default() };
    if state.sleepers.is_some() || !state.zones.none() {
        lists.slots.index();
    }
    note_near(state);
    if state.sleepers.is_some() {
        lists.slots.mark_wall_blocks(&model.walls);
        lists.step.resting_tiles = lists.slots.resting_tiles();
    }
}

/// Whether two particles touched where they were listed.
fn touch(state: &State, &(i, j): &Pair) -> bool {
    let p = &state.particles;
    let of = |k: u32| (&p.home[k as usize], p.rows[k as usize].radius());
    let [a, b] = [of(i), of(j)];
    touched([a.0, b.0], [a.1, b.1])
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
            let room = wall.room(state.particles.rows[k].radius());
            let (position, reach) =
                (state.particles.home[k].vector(), state.particles.reach(k) + moves + room);
            for (image, shift) in around.near(&position, reach) {
                let first = image.0 * wall.parts();
                let add = |part| list.push(k as u32, first + part);
                wall.parts_near(pose.home(&(position - shift)), reach, image.0 > 0, add);
            }
        }
    }
}

/// How far a wall may move until lists are rebuilt [m].
pub fn wall_margin(model: &Model, state: &State, wall: usize) -> f64 {
    let speed = model.walls[wall].fastest();
    margin(state.listing.skin, model.horizon * model.dt * speed, model.mean_radius) + model.ahead() * speed
}

/// Pairs across periodic faces: each once, by the half of all shifts whose first part that is not zero is positive.
fn list_images(model: &Model, state: &State, search: &Search) -> Vec<List> {
    let mut found = Vec::new();
    let (cell, room) = state.cell_as_listed(model);
    for image in cell.half_of_images() {
        search.image_pairs(image, &cell.shift(&image), room, &mut found);
    }
    state.clumps.drop_own(&mut found, |f| (f.i, f.j));
    state.bonds.drop_replaced(&mut found, |f| (f.i, f.j));
    found.sort_by_key(|f| (f.i, f.j));
    let class = classes(model, With::Images);
    let mut lists = vec![List::default(); model.kinds.len()];
    let material = |k: u32| state.particles.material[k as usize];
    for ImagePair { i, j, image } in found {
        let list = &mut lists[class.of(material(i), material(j))];
        list.push(i, j);
        list.image.push(image);
    }
    lists
}

/// Allocates what is computed in each step; last, when old lists are gone.
pub fn allocate(model: &Model, state: &mut State, lists: &mut NeighbourLists) {
    let (torques, keeps) = (state.torques(model), state.keeps_wrenches());
    lists.step.kept = WrenchColumns::zeros(model.layout(), lists.slots.kept(), torques);
    state.contacts.allocate(lists.slots.i.len(), state.particles.len(), torques, model.setup.ledger);
    let with_walls = if state.wall_sums.none() { 0 } else { lists.slots.i.len() };
    state.contacts.touched.resize(with_walls, 0);
    state.contacts.keep_wrenches(keeps, lists.slots.i.len());
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
    let strained = state.strained.as_ref().is_some_and(|cell| cell.has_left_room());
    state.listing.status != ListStatus::Valid || strained || !walls_stay(model, state, state.steps)
}

/// Whether no wall has left its margin at `step`, as far as its motion is prescribed.
fn walls_stay(model: &Model, state: &State, step: u64) -> bool {
    let since = (step - state.listing.step) as f64 * model.dt;
    // Written so that NaN is caught.
    let holds = |w: usize| {
        let ahead = model.ahead() * model.walls[w].fastest();
        wall_shift(model, state, w, since) + ahead <= wall_margin(model, state, w)
    };
    (0..model.walls.len()).all(holds)
}

/// Steps from now on, `most` at most, in which no wall leaves its margin.
pub fn steps_of_walls(model: &Model, state: &State, most: u64) -> u64 {
    if model.walls.iter().all(|wall| wall.fastest() == 0.0) {
        return most;
    }
    // The longer a wall moves, the farther it may be.
    let (mut stay, mut leave) = (1, most + 1);
    while leave - stay > 1 {
        let middle = stay + (leave - stay) / 2;
        *if walls_stay(model, state, state.steps + middle - 1) { &mut stay } else { &mut leave } = middle;
    }
    stay
}

/// Notes which particles may pass a storage plane, or come back through it, before the next rebuild: only their margins reach it. Members of clumps
/// are always noted, because the centre of a clump may be nearer than they are; so are those that have crossed, until they leave.
fn note_near(state: &mut State) {
    let (p, zones) = (&state.particles, &state.zones);
    let near = |(outlet, zone): (usize, &Zone)| {
        let (beyond, crossed) = (&zones.beyond[outlet], &zones.crossed[outlet]);
        let stays = |k: usize| {
            let (home, margin) = (p.home[k].vector(), p.home[k][3]);
            let past = zone.past(&home, p.rows[k].radius());
            !state.clumps.is_member(k)
                && !crossed.contains(&p.id[k])
                && (past < -margin || (past > margin && beyond.contains(&p.id[k])))
        };
        (0..p.len() as u32).filter(|&k| !stays(k as usize)).collect()
    };
    state.zones.near = zones.outlets.iter().enumerate().map(near).collect();
}

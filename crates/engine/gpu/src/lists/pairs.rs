//! What may touch: pairs of particles, of particles and images, and parts of walls near particles. Each function runs twice, to count and to write.

use super::near::Sorted;
use super::{WRITE, add};
use crate::tables::lists::DeviceWall;
use crate::tables::{Address, DeviceKind, DeviceMesh, DeviceTables, MESH, PLANE, SPHERES};
use laws::contact::seams::{self, Nearest};
use laws::simd::{Row, Row4};
use laws::space::margins::touched;
use primitives::{BoxTree, Vec3};

/// Pairs that are put at once.
const FOUND: usize = 12;

/// Whether a particle that reaches so far is sought for itself, because cells are made for less.
#[inline(always)]
fn is_wide(t: &DeviceTables, reach: f64) -> bool {
    2.0 * reach > t.lists.lattice.cell
}

#[inline(always)]
fn particles(t: &DeviceTables) -> Sorted<'_> {
    let l = &t.lists;
    let (starts, cells) = (l.cell_starts, l.cells as usize);
    Sorted { lattice: &l.lattice, keys: l.keys, starts, cells, count: t.particle_count as usize }
}

/// First particle of a cell.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
pub unsafe fn cell_starts(t: &DeviceTables, _: u32, cell: usize) {
    if cell > t.lists.cells as usize {
        return;
    }
    // SAFETY: by contract.
    unsafe { *t.lists.cell_starts.at(cell) = particles(t).bisect(cell as u64) as u32 }
}

/// The kind of contact of two particles, by a table of kinds of two materials.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
unsafe fn kind_of(t: &DeviceTables, images: bool, i: usize, j: usize) -> &DeviceKind {
    let kinds = if images { t.lists.image_kinds } else { t.lists.pair_kinds };
    // SAFETY: by contract.
    unsafe {
        let (a, b): (u32, u32) = (*t.particles.material.at(i), *t.particles.material.at(j));
        let kind: u32 = *kinds.at((a * t.lists.materials + b) as usize);
        &*t.kinds.at(kind as usize)
    }
}

/// Counts a contact of particle `i` among those of the particle and class number `row`, or has its slot; none where that is beyond all slots.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
unsafe fn place(t: &DeviceTables, mode: u32, row: usize, class: usize) -> Option<usize> {
    // SAFETY: by contract; cursors stand after the first number of their table.
    unsafe {
        let at = add(t.lists.class_cursors.at(1 + row), 1);
        if mode != WRITE {
            return None;
        }
        let slot = at.wrapping_add(*t.lists.class_slots.at(class));
        if slot >= t.slot_count {
            t.beyond(0);
            return None;
        }
        Some(slot as usize)
    }
}

/// Row of the cursors of particle `i` for a class of its tile, and the number of that.
#[inline(always)]
fn row_of(t: &DeviceTables, i: usize, class: u32) -> (usize, usize) {
    let (l, tile) = (&t.lists, t.tile as usize);
    let of = i / tile;
    let before = l.image_classes as usize * t.particle_count as usize;
    let row = before + (of * l.classes as usize + class as usize) * tile + i % tile;
    (row, l.class_of(of, class))
}

/// # Safety
/// Tables are in place.
#[inline(always)]
unsafe fn put_pair(t: &DeviceTables, mode: u32, i: usize, j: usize) {
    let tile = t.tile as usize;
    // SAFETY: by contract.
    unsafe {
        let radius = |k: usize| (&*t.particles.rows.at::<Row>(k))[3];
        let home = |k: usize| &*t.particles.home.at::<Row4>(k);
        let apart = !touched([home(i), home(j)], [radius(i), radius(j)]);
        let later = j / tile != i / tile;
        let class = kind_of(t, false, i, j).class + 2 * u32::from(later) + u32::from(apart);
        let (row, class) = row_of(t, i, class);
        if let Some(slot) = place(t, mode, row, class) {
            (*t.contacts.i.at(slot), *t.contacts.partner.at(slot)) = (i as u32, j as u32);
        }
    }
}

/// Pairs of a particle with later ones, both of which reach no farther than half a cell.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
pub unsafe fn common_pairs(t: &DeviceTables, mode: u32, i: usize) {
    if i >= t.particle_count as usize {
        return;
    }
    // SAFETY: by contract.
    unsafe {
        let spot: Row4 = *t.lists.spots.at(i);
        let (p, reach) = (spot.vector(), spot[3]);
        if is_wide(t, reach) {
            return;
        }
        // Put some at a time: threads that run together find theirs in different turns, but put them in the same.
        let (mut found, mut count) = ([0_u32; FOUND], 0);
        // The cells that the processor looks into: by rounding, a pair at just the distance that counts may be two cells apart.
        let cell = t.lists.lattice.cell_of(&p);
        particles(t).in_cells([cell.map(|c| c - 1), cell.map(|c| c + 1)], i + 1, |j| {
            let other: Row4 = *t.lists.spots.at(j);
            let close = reach + other[3];
            let near = (other.vector() - p).norm_squared() < close * close && close > 0.0;
            if near && !is_wide(t, other[3]) {
                if count == FOUND {
                    found.iter().for_each(|&j| put_pair(t, mode, i, j as usize));
                    count = 0;
                }
                found[count] = j as u32;
                count += 1;
            }
        });
        found.iter().take(count).for_each(|&j| put_pair(t, mode, i, j as usize));
    }
}

/// Pairs of a particle that reaches farther than half a cell.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
pub unsafe fn wide_pairs(t: &DeviceTables, mode: u32, w: usize) {
    if w >= t.particle_count as usize {
        return;
    }
    // SAFETY: by contract.
    unsafe {
        let spot: Row4 = *t.lists.spots.at(w);
        let (p, reach) = (spot.vector(), spot[3]);
        if !is_wide(t, reach) {
            return;
        }
        // No partner that reaches less far is farther away than twice its own reach.
        particles(t).near(&p, 2.0 * reach, 0, |j| {
            let other: Row4 = *t.lists.spots.at(j);
            let close = reach + other[3];
            if is_behind(t, (other[3], j), (reach, w)) && (other.vector() - p).norm_squared() < close * close
            {
                put_pair(t, mode, w.min(j), w.max(j));
            }
        });
    }
}

/// Whether a particle, by its reach and number, reaches less far than a wide one, which finds their pair; of two equal ones the later finds it.
#[inline(always)]
fn is_behind(t: &DeviceTables, j: (f64, usize), w: (f64, usize)) -> bool {
    !is_wide(t, j.0) || j < w
}

/// Pairs of a particle with images across periodic faces: of two that reach no farther than half a cell the first finds them, and else the one that reaches farther.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
pub unsafe fn image_pairs(t: &DeviceTables, mode: u32, k: usize) {
    let (l, count) = (&t.lists, t.particle_count as usize);
    if k >= count {
        return;
    }
    // SAFETY: by contract.
    unsafe {
        let spot: Row4 = *l.spots.at(k);
        let reach = spot[3];
        let wide = is_wide(t, reach);
        let far = if wide { 2.0 * reach } else { reach + 0.5 * l.lattice.cell };
        for image in 0..l.images {
            let along = l.along(&(*l.shifts.at::<Row4>(image as usize)).vector());
            for is_second in [false, true] {
                if is_second && !wide {
                    continue;
                }
                let p = if is_second { spot.vector() + along } else { spot.vector() - along };
                let outside = |a: usize| p[a] < l.bounds[0][a] - far || p[a] > l.bounds[1][a] + far;
                if outside(0) || outside(1) || outside(2) {
                    continue;
                }
                particles(t).near(&p, far, 0, |n| {
                    let other: Row4 = *l.spots.at(n);
                    let takes = if wide {
                        is_behind(t, (other[3], n), (reach, k)) || n == k && !is_second
                    } else {
                        !is_wide(t, other[3])
                    };
                    let (i, j) = if is_second { (n, k) } else { (k, n) };
                    let [a, b] = if is_second { [other, spot] } else { [spot, other] };
                    let close = a[3] + b[3];
                    if takes && (b.vector() - (a.vector() - along)).norm_squared() < close * close {
                        put_image(t, mode, (i, j), image);
                    }
                });
            }
        }
    }
}

/// # Safety
/// Tables are in place.
#[inline(always)]
unsafe fn put_image(t: &DeviceTables, mode: u32, (i, j): (usize, usize), image: u32) {
    // SAFETY: by contract.
    unsafe {
        let class = kind_of(t, true, i, j).class as usize;
        if let Some(slot) = place(t, mode, class * t.particle_count as usize + i, class) {
            (*t.contacts.i.at(slot), *t.contacts.partner.at(slot)) = (i as u32, j as u32);
            *t.lists.image.at(slot) = image as u8;
        }
    }
}

/// The tree of the triangles of a wall.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
unsafe fn triangles<'a>(t: &'a DeviceTables, mesh: &DeviceMesh) -> BoxTree<'a> {
    // SAFETY: by contract.
    unsafe {
        let (nodes, order) = (t.table(mesh.nodes, mesh.node_count), t.table(mesh.order, mesh.parts));
        BoxTree { nodes, order, boxes: t.table(mesh.boxes, mesh.parts) }
    }
}

/// Parts of walls near a particle.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
pub unsafe fn wall_parts(t: &DeviceTables, mode: u32, k: usize) {
    if k >= t.particle_count as usize {
        return;
    }
    // SAFETY: by contract.
    unsafe {
        let (home, row): (Row4, &Row) = (*t.particles.home.at(k), &*t.particles.rows.at(k));
        let (position, material): (Vec3, u32) = (home.vector(), *t.particles.material.at(k));
        for kind in 0..t.lists.kind_count as usize {
            let kind: &DeviceKind = &*t.kinds.at(kind);
            if kind.with < SPHERES || kind.between[0] != material {
                continue;
            }
            let wall: &DeviceWall = &*t.lists.walls.at(kind.wall as usize);
            let mesh: DeviceMesh =
                if kind.with == MESH { *t.meshes.at(kind.wall as usize) } else { DeviceMesh::default() };
            let room = if kind.with == MESH { seams::room(row.radius(), mesh.reach) } else { 0.0 };
            let reach = row.radius() + home[3] + wall.margin + room;
            for (image, shift) in wall.around.near(&position, reach) {
                let (row, class) = row_of(t, k, kind.class);
                let put = |part: usize| {
                    if let Some(slot) = place(t, mode, row, class) {
                        *t.contacts.i.at(slot) = k as u32;
                        *t.contacts.partner.at(slot) = image.0 * wall.parts + part as u32;
                    }
                };
                let p = wall.pose.home(&(position - shift));
                if kind.with == PLANE {
                    let [point, normal] = kind.plane.map(Vec3::from);
                    let distance = (p - point).dot(&normal);
                    // Behind a plane is where it is to be noticed; behind its image is the next period.
                    if distance < reach && (image.0 == 0 || distance > -reach) {
                        put(0);
                    }
                    continue;
                }
                if kind.with == MESH {
                    triangles(t, &mesh).near(&p, reach, |part| {
                        let part = part as usize;
                        let is_doubled =
                            mesh.doubled != Address::default() && *mesh.doubled.at::<u8>(part) != 0;
                        let close =
                            || Nearest::of(*mesh.corners.at(part), p).way.norm_squared() < reach * reach;
                        if !is_doubled && close() {
                            put(part);
                        }
                    });
                    continue;
                }
                let (lattice, keys, starts) = (&wall.lattice, wall.keys, Address::default());
                let spheres = Sorted { lattice, keys, starts, cells: 0, count: wall.parts as usize };
                spheres.near(&p, reach + wall.largest, 0, |part| {
                    let sphere: Row4 = *wall.spheres.at(part);
                    let close = reach + sphere[3];
                    if (sphere.vector() - p).norm_squared() < close * close {
                        put(part);
                    }
                });
            }
        }
    }
}

//! One kind of contact: its law, its list, its memory.
//!
//! A kind is a pair of materials that particles have, or a wall and a material. Each has its own composition of effects,
//! so that a frictionless pair takes no memory even where another pair has friction.

use crate::kernel::{Common, Kernel, LEDGER, Task};
use crate::lane::{BLOCK, Row, Row4};
use crate::particles::{FAR, Particles};
use crate::walls::WallBody;
use geom::Vec3;
use rayon::prelude::*;

/// Contacts of one task.
const CHUNK: usize = 64 * BLOCK;
/// Whom the particles of an interaction meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum With {
    /// Each other.
    Particles,
    /// Each other across a periodic face.
    Images,
    /// The wall of this number.
    Wall(usize),
}

/// Contacts that share a law.
pub struct Interaction {
    /// The law.
    pub kernel: Box<dyn Kernel>,
    /// Materials, lower first; of the particle, then of the wall.
    pub between: (u16, u16),
    /// Whom they meet.
    pub with: With,
    /// Number of contacts listed.
    pub len: usize,
    /// First particle, in whole blocks.
    pub i: Vec<u32>,
    /// Second particle, or part of the wall, in whole blocks.
    pub partner: Vec<u32>,
    /// Place of each contact in `partner_rows`; empty for pairs.
    place: Vec<u32>,
    /// Shift of an image [m].
    shift: Vec<Vec3>,
    partner_rows: Vec<Row>,
    partner_spins: Vec<Row4>,
    memory: Vec<f64>,
    active: Vec<bool>,
    /// Place of the first contact among all loads.
    pub first_load: usize,
}

/// Contacts to be listed, ordered by particle.
#[derive(Debug, Clone, Default)]
pub struct List {
    /// Particle.
    pub i: Vec<u32>,
    /// Other particle, or part of the wall.
    pub partner: Vec<u32>,
    /// Shift of the other particle's image [m]; empty for all but images.
    pub shift: Vec<Vec3>,
}

impl List {
    /// Adds a contact at the end.
    pub fn push(&mut self, i: u32, partner: u32) {
        self.i.push(i);
        self.partner.push(partner);
    }
}

impl Interaction {
    /// Without contacts yet.
    pub fn new(kernel: Box<dyn Kernel>, between: (u16, u16), with: With) -> Interaction {
        let none = Vec::new;
        Interaction {
            kernel,
            between,
            with,
            len: 0,
            i: none(),
            partner: Vec::new(),
            place: Vec::new(),
            shift: Vec::new(),
            partner_rows: Vec::new(),
            partner_spins: Vec::new(),
            memory: Vec::new(),
            active: Vec::new(),
            first_load: 0,
        }
    }

    /// Places for loads that it takes: whole blocks.
    pub fn places(&self) -> usize {
        self.i.len()
    }

    /// Replaces the list; `particles` is the number of particles. Memory starts at zero.
    pub fn list(&mut self, list: List, particles: usize) {
        self.len = list.i.len();
        let padded = self.len.next_multiple_of(BLOCK);
        (self.i, self.partner, self.shift) = (list.i, list.partner, list.shift);
        self.i.resize(padded, particles as u32);
        self.partner.resize(padded, particles as u32 + 1);
        if self.with != With::Particles {
            self.place = (0..padded as u32).collect();
            self.partner_rows = vec![FAR[1]; padded];
            self.partner_spins = if self.kernel.rotates() { vec![[0.0; 4]; padded] } else { Vec::new() };
        }
        self.memory = vec![0.0; padded * self.kernel.memory()];
        self.active = vec![true; padded / BLOCK];
    }

    /// Finds the contact points of images and walls as they are at `time` [s].
    pub fn renew(&mut self, particles: &Particles, walls: &[WallBody], time: f64, listed_now: bool) {
        match self.with {
            With::Particles => {}
            With::Images => self.renew_images(particles),
            With::Wall(w) if listed_now || walls[w].renewed() => {
                let pose = walls[w].motion.pose(time);
                let mut from = 0;
                while from < self.len {
                    let i = self.i[from];
                    let to = from + self.i[from..self.len].iter().take_while(|&&k| k == i).count();
                    let spins = if self.partner_spins.is_empty() {
                        &mut []
                    } else {
                        &mut self.partner_spins[from..to]
                    };
                    let parts = &self.partner[from..to];
                    walls[w].meet(
                        &pose,
                        particles.position(i as usize),
                        parts,
                        &mut self.partner_rows[from..to],
                        spins,
                    );
                    from = to;
                }
            }
            With::Wall(_) => {}
        }
    }

    fn renew_images(&mut self, particles: &Particles) {
        for k in 0..self.len {
            let (j, shift) = (self.partner[k] as usize, self.shift[k]);
            let mut row = particles.rows[j];
            for a in 0..3 {
                row[a] += shift[a];
            }
            self.partner_rows[k] = row;
            if let Some(spin) = self.partner_spins.get_mut(k) {
                *spin = particles.spins[j];
            }
        }
    }

    /// Its contacts as tasks, each with its part of the loads, couples and ledger.
    pub fn tasks<'a>(
        &'a mut self,
        common: &Common<'a>,
        walls: &[WallBody],
        mut loads: &'a mut [f64],
        mut couples: &'a mut [f64],
        mut ledger: &'a mut [f64],
        out: &mut Vec<(&'a dyn Kernel, Task<'a>)>,
    ) {
        let (partners, j) = match self.with {
            With::Particles => ((common.rows, common.spins), &self.partner),
            _ => ((&self.partner_rows[..], &self.partner_spins[..]), &self.place),
        };
        let flat = matches!(self.with, With::Wall(w) if walls[w].flat());
        let columns = self.kernel.memory();
        let mut memory = &mut self.memory[..];
        let blocks = self.i.chunks(CHUNK).zip(j.chunks(CHUNK)).zip(self.active.chunks_mut(CHUNK / BLOCK));
        for ((i, j), active) in blocks {
            let n = i.len();
            out.push((
                &*self.kernel,
                Task {
                    partners,
                    flat,
                    i,
                    j,
                    memory: take(&mut memory, n * columns),
                    active,
                    loads: take(&mut loads, n * common.stride),
                    couples: take(&mut couples, n * 4),
                    ledger: take(&mut ledger, n * LEDGER),
                },
            ));
        }
    }

    /// Takes list and memory out, and leaves none.
    pub fn take_lists(&mut self) -> Interaction {
        let empty = Interaction::new(Box::new(()), self.between, self.with);
        let (i, partner, memory) = (&mut self.i, &mut self.partner, &mut self.memory);
        Interaction {
            i: std::mem::take(i),
            partner: std::mem::take(partner),
            memory: std::mem::take(memory),
            len: std::mem::take(&mut self.len),
            ..empty
        }
    }

    /// Fills the memory of each contact from what `find` knows of (particle, partner): a sign, an old list and the place in it.
    pub fn recall<'a>(&mut self, find: impl Fn(u32, u32) -> Option<(f64, &'a Interaction, usize)> + Sync) {
        let columns = self.kernel.memory();
        if columns == 0 {
            return;
        }
        let (len, i, partner) = (self.len, &self.i, &self.partner);
        self.memory.par_chunks_mut(CHUNK * columns).enumerate().for_each(|(chunk, memory)| {
            for k in chunk * CHUNK..((chunk + 1) * CHUNK).min(len) {
                let Some((sign, old, from)) = find(i[k], partner[k]) else { continue };
                for c in 0..columns {
                    memory[place(k - chunk * CHUNK, c, columns)] = sign * old.memory[place(from, c, columns)];
                }
            }
        });
    }

    /// All memory, for checkpoints.
    pub fn all_memory(&self) -> &[f64] {
        &self.memory
    }

    /// Puts back what [`Interaction::all_memory`] gave; false when the size is another.
    pub fn restore_memory(&mut self, memory: &[f64]) -> bool {
        if memory.len() != self.memory.len() {
            return false;
        }
        self.memory.copy_from_slice(memory);
        true
    }
}

/// Where number `c` of contact `k` is in memory of so many columns.
fn place(k: usize, c: usize, columns: usize) -> usize {
    (k / BLOCK * columns + c) * BLOCK + k % BLOCK
}

/// Splits the first `n` numbers off; all there are when the slice is empty or shorter.
fn take<'a>(from: &mut &'a mut [f64], n: usize) -> &'a mut [f64] {
    let n = n.min(from.len());
    let (head, tail) = std::mem::take(from).split_at_mut(n);
    *from = tail;
    head
}

impl Interaction {
    /// Where the partner of an image's or wall's contact was when loads were computed [m].
    pub fn place_of_partner(&self, contact: usize) -> Vec3 {
        let row = &self.partner_rows[contact];
        Vec3::new(row[0], row[1], row[2])
    }

    /// Its radius [m]; 0 on a flat wall.
    pub fn radius_of_partner(&self, contact: usize) -> f64 {
        self.partner_rows[contact][3]
    }
}

impl Interaction {
    /// Memory that lists, contact points and contact memory take [bytes].
    pub fn bytes(&self) -> usize {
        use std::mem::size_of_val;
        size_of_val(&self.i[..])
            + size_of_val(&self.place[..])
            + size_of_val(&self.partner[..])
            + size_of_val(&self.shift[..])
            + size_of_val(&self.partner_rows[..])
            + size_of_val(&self.partner_spins[..])
            + size_of_val(&self.memory[..])
            + size_of_val(&self.active[..])
    }
}

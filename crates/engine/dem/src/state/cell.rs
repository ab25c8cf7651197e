//! The periodic cell where it is strained.

use crate::model::Model;
use crate::model::check::least_period;
use crate::setup::Setup;
use crate::state::{Governor, Held, State};
use geom::Vec3;
use laws::space::cell::Cell;
use serde::{Deserialize, Serialize};

/// State of a periodic cell that is strained. Its centre stays.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CellState {
    /// Logarithmic strain of each axis since t = 0, compression positive [–].
    pub strain: Vec3,
    /// The same a step later.
    pub next: Vec3,
    /// Lengths at t = 0, now, and a step later [m]; 0 along open axes.
    pub lengths: [Vec3; 3],
    /// Least length [m]: below it a particle would meet itself.
    pub least: f64,
    /// Centre [m].
    centre: Vec3,
    /// Δt [s].
    dt: f64,
    /// Axes that follow a stress.
    pub followers: [Option<Follower>; 3],
    /// Lengths when neighbours were listed [m].
    listed: Vec3,
    /// By how much they may change until neighbours are listed again [m].
    room: f64,
}

/// An axis that follows a stress.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Follower {
    /// Its rate of strain [1/s].
    pub governor: Governor,
    /// How far its stress has been from the one it follows.
    pub held: Held,
    /// Number of contacts and bonds when their stiffness was summed last.
    pub contacts: u32,
    /// How stiffly they answer: Σ (k Δt + c) l²/V [Pa·s], l: distance of the centres along the axis.
    pub response: f64,
}

impl CellState {
    /// At t = 0; `None` where no axis is strained.
    pub fn new(setup: &Setup, dt: f64) -> Option<CellState> {
        if setup.strain.iter().all(Option::is_none) {
            return None;
        }
        let cell = Cell::at_rest(setup.periodic);
        let lengths = cell.lengths();
        let follows = |axis: &Option<crate::setup::Strain>| axis.as_ref().and_then(|s| s.stress(0.0));
        let mut new = CellState {
            strain: Vec3::zeros(),
            next: Vec3::zeros(),
            lengths: [lengths; 3],
            least: least_period(setup),
            centre: cell.centre(),
            dt,
            followers: setup.strain.each_ref().map(|axis| follows(axis).map(|_| Follower::default())),
            listed: lengths,
            room: 0.0,
        };
        let next =
            setup.strain.each_ref().map(|axis| axis.as_ref().and_then(|s| s.prescribed(dt)).unwrap_or(0.0));
        new.prepare(Vec3::from(next));
        Some(new)
    }

    /// Goes on to the next instant; `next` is the strain of the one after it.
    pub fn advance(&mut self, next: Vec3) {
        (self.strain, self.lengths[1]) = (self.next, self.lengths[2]);
        self.prepare(next);
    }

    fn prepare(&mut self, next: Vec3) {
        self.next = next;
        self.lengths[2] = Vec3::from([0, 1, 2].map(|a| self.lengths[0][a] * libm::exp(-next[a])));
    }

    /// At this instant.
    pub fn cell(&self) -> Cell {
        Cell { range: self.range(&self.lengths[1]), speed: (self.lengths[2] - self.lengths[1]) / self.dt }
    }

    fn range(&self, lengths: &Vec3) -> [Option<(f64, f64)>; 3] {
        let half = |a: usize| 0.5 * lengths[a];
        [0, 1, 2].map(|a| (half(a) > 0.0).then(|| (self.centre[a] - half(a), self.centre[a] + half(a))))
    }

    /// Notes that neighbours are listed, with this room [m].
    pub fn list(&mut self, room: f64) {
        (self.listed, self.room) = (self.lengths[1], room);
    }

    /// Fastest change of a length [m/s].
    pub fn fastest(&self) -> f64 {
        self.cell().speed.amax()
    }

    /// Whether images may have come nearer than they were listed. Written so that NaN is caught.
    pub fn has_left_room(&self) -> bool {
        !((self.lengths[2] - self.listed).amax() <= self.room)
    }

    /// Whether its numbers are finite.
    pub fn is_finite(&self) -> bool {
        self.lengths.iter().flatten().chain(&self.next).all(|x| x.is_finite())
    }
}

impl State {
    /// The periodic cell at this instant.
    pub fn cell(&self, model: &Model) -> Cell {
        self.strained.as_ref().map_or_else(|| model.cell(), CellState::cell)
    }

    /// As it was when neighbours were listed, and how much nearer images may have come since [m].
    pub fn cell_as_listed(&self, model: &Model) -> (Cell, f64) {
        let listed = |c: &CellState| (Cell::at_rest(c.range(&c.listed)), c.room);
        self.strained.as_ref().map_or_else(|| (model.cell(), 0.0), listed)
    }
}

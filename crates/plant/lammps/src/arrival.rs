//! A grain that comes in: what moves its atom until it is free.

use crate::places::number_of;
use geom::Vec3;

/// A grain that comes in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arrival {
    pub id: u32,
    /// When it enters the zone [s].
    pub enters: f64,
    /// When it moves freely [s].
    pub free: f64,
    /// What moves it until then.
    pub(crate) way: Way,
}

/// A change of velocity [m/s] in a step.
pub(crate) type Kick = (f64, Vec3);

/// What moves the atom of a grain until it is free.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Way {
    /// Step from which gravity acts on it.
    pub(crate) falls: f64,
    pub(crate) leaves: Kick,
    pub(crate) comes: Kick,
}

impl Arrival {
    /// Names of its numbers in LAMMPS.
    pub const NAMES: &str = "d_free d_falls d_leaves d_lx d_ly d_lz d_comes d_cx d_cy d_cz";

    /// Its numbers, in the order of [`Arrival::NAMES`].
    pub fn numbers(&self) -> [f64; 10] {
        let Way { falls, leaves: (k, u), comes: (n, v) } = self.way;
        [self.free, falls, k, u.x, u.y, u.z, n, v.x, v.y, v.z]
    }

    /// The force on the atoms of a group `waiting`, as commands; `c_way` has the numbers.
    pub fn commands(gravity: &Vec3) -> String {
        let one = |(axis, name): (usize, &str)| {
            format!(
                "variable way{name} atom \"mass*((step>=c_way[2])*({:?})+((step==c_way[3])*c_way[{}]+(step==c_way[7])*c_way[{}])/dt)\"\n",
                gravity[axis],
                4 + axis,
                8 + axis
            )
        };
        let forces: String = ["x", "y", "z"].into_iter().enumerate().map(one).collect();
        format!(
            "\n# what moves grains that come in: the last force\n{forces}fix way_in waiting setforce v_wayx v_wayy v_wayz\n"
        )
    }
}

/// Whether the grain of an atom is free at a time [s]: all are but those that still come in.
pub fn is_free(arrivals: &[Arrival], number: u64, time: f64) -> bool {
    let found = arrivals.binary_search_by_key(&number, |a| number_of(a.id));
    found.map_or(true, |index| arrivals[index].free <= time)
}

//! What contacts bear at each frame: dumps of the pairs of atoms that touch, and of the grains that touch planes.
//!
//! ```text
//! pairs.dump     i j, (F_n n)x y z, (F_t)x y z        of the force on i            compute pair/local, property/local
//! touches.dump   i, then for each fix of a plane: 1 or 0, Fx Fy Fz on i            fix wall/gran/region … contacts
//! ```
//!
//! Where the two touch, n and the overlap follow from the frame. Forces of planes are those of the step; LAMMPS computes those of pairs again at the end of the
//! step, so a dashpot has the speed half a step later.

use crate::dump::{Block, Dump, Ended, block};
use crate::files::{COLUMNS, OF_BONDS, PAIRS, TOUCHES, TURNS, ZONE};
use crate::instant::{Now, particle};
use crate::joined;
use crate::places::{nearest, number_of, wrapped};
use crate::types::{Types, law};
use dem::ContactRecord;
use dem::WallForce;
use dem::setup::{Setup, WallShape};
use geom::Vec3;
use scene::keys::SceneKeys;
use std::fmt::Write;

/// Columns of the pairs.
const OF_PAIRS: &str =
    "c_ends[1] c_ends[2] c_loads[1] c_loads[2] c_loads[3] c_loads[4] c_loads[5] c_loads[6]";
/// Numbers of a grain at a fix of a plane.
const AT_PLANE: usize = 4;

/// What a scene asks for beside its frames.
#[derive(Debug, Clone, PartialEq)]
pub struct Asked {
    pub contacts: bool,
    /// Forces on walls.
    pub walls: bool,
    /// The fixes of planes: wall, and type of the grains.
    fixes: Vec<(usize, usize)>,
    spheres: bool,
    outlets: bool,
    bonds: bool,
    /// Whether grains bear a force that do not touch: the necks of JKR.
    necks: bool,
}

impl Asked {
    /// What the keys of a scene ask for.
    pub fn of(keys: &SceneKeys, setup: &Setup, types: &Types) -> Asked {
        Asked {
            contacts: keys.output.contacts,
            walls: keys.output.wall_forces == Some(true),
            fixes: at_planes(setup, types).collect(),
            necks: setup.contacts.iter().any(|law| law.model("law") == Some("jkr")),
            outlets: !setup.outlets.is_empty(),
            bonds: !setup.bonds.is_empty(),
            spheres: setup.walls.iter().any(|w| matches!(w.shape, WallShape::Spheres(_))),
        }
    }

    /// Whether the deck writes a dump.
    pub fn has(&self, dump: &str) -> bool {
        match dump {
            ZONE => self.outlets,
            PAIRS => self.pairs(),
            TOUCHES => self.touches(),
            OF_BONDS => self.bonds,
            _ => true,
        }
    }

    /// Columns of frames.
    pub fn of_frames(&self) -> String {
        format!("{COLUMNS}{}", if self.bonds { TURNS } else { "" })
    }

    /// Whether pairs are dumped.
    fn pairs(&self) -> bool {
        self.contacts || self.walls && self.spheres
    }

    /// Whether touches are dumped.
    pub fn touches(&self) -> bool {
        (self.contacts || self.walls) && !self.fixes.is_empty()
    }

    fn columns(&self) -> String {
        let of = |(wall, kind): &(usize, usize)| {
            (1..=AT_PLANE).map(|k| format!(" f_wall{wall}_{kind}[{k}]")).collect::<String>()
        };
        format!("id{}", self.fixes.iter().map(of).collect::<String>())
    }

    pub fn commands(&self) -> String {
        let mut text = String::new();
        let how = "every v_next first ${first} flush yes format float %.17g";
        if self.pairs() {
            let reach = if self.necks { "type" } else { "radius" };
            let _ = write!(
                text,
                "\n# pairs that touch\ncompute ends all property/local patom1 patom2 cutoff {reach}\n\
                 compute loads all pair/local fx fy fz p1 p2 p3 cutoff {reach}\nvariable pairs index {PAIRS}\n\
                 dump pairs all local 1 ${{pairs}} {OF_PAIRS}\ndump_modify pairs {how}\n"
            );
        }
        if self.bonds {
            text += &joined::commands(how);
        }
        if self.touches() {
            let flags: Vec<String> =
                self.fixes.iter().map(|(wall, kind)| format!("f_wall{wall}_{kind}[1]")).collect();
            let _ = write!(
                text,
                "\n# grains that touch planes\nvariable touch atom \"{}\"\nvariable touches index {TOUCHES}\n\
                 dump touches grains custom 1 ${{touches}} {}\ndump_modify touches {how} thresh v_touch > 0\n",
                flags.join("+"),
                self.columns()
            );
        }
        text
    }
}

/// The fixes of planes: wall, and type of the grains that meet it.
pub fn at_planes<'a>(setup: &'a Setup, types: &'a Types) -> impl Iterator<Item = (usize, usize)> + 'a {
    let planes = setup.walls.iter().enumerate().filter(|(_, w)| matches!(w.shape, WallShape::Plane(_)));
    planes.flat_map(move |(index, wall)| {
        let meets = move |(_, grain): &(usize, &crate::types::AtomType)| {
            law(setup, grain.material, wall.material).is_some()
        };
        types.grains().filter(meets).map(move |(number, _)| (index, number))
    })
}

/// Reads what contacts bear, frame by frame.
pub struct Loads<'a> {
    asked: &'a Asked,
    pairs: Option<Dump<'a>>,
    touches: Option<Dump<'a>>,
    /// Number of the first wall sphere, and the wall of each with its centre at t = 0 and its radius.
    first: u64,
    spheres: Vec<(usize, Vec3, f64)>,
}

impl<'a> Loads<'a> {
    /// Of dumps that are there where they are asked for.
    pub fn new(
        asked: &'a Asked,
        setup: &Setup,
        [pairs, touches]: [Option<crate::dump::Parts<'a>>; 2],
    ) -> Loads<'a> {
        let first = setup.particles.iter().map(|p| number_of(p.id)).max().unwrap_or(0) + 1;
        let spheres = setup.walls.iter().enumerate().flat_map(|(index, wall)| match &wall.shape {
            WallShape::Spheres(all) => all.iter().map(|(c, r)| (index, *c, *r)).collect(),
            _ => Vec::new(),
        });
        let pairs = pairs.map(|parts| Dump::new(parts, OF_PAIRS));
        let touches = touches.map(|parts| Dump::new(parts, &asked.columns()));
        Loads { pairs, touches, first, spheres: spheres.collect(), asked }
    }

    /// The contacts at a frame.
    ///
    /// # Errors
    /// A dump that ends, or is wrong.
    pub fn at(&mut self, now: &Now) -> Result<Vec<ContactRecord>, Ended> {
        let mut all = Vec::new();
        if let Some(pairs) = block(&mut self.pairs, now.step)? {
            self.pairs(&pairs, now, &mut all)?;
        }
        if let Some(touches) = block(&mut self.touches, now.step)? {
            self.touches(&touches, now, &mut all)?;
        }
        Ok(all)
    }

    fn pairs(&self, pairs: &Block, now: &Now, all: &mut Vec<ContactRecord>) -> Result<(), Ended> {
        for row in pairs.rows() {
            let force = Vec3::new(row[2] + row[5], row[3] + row[6], row[4] + row[7]);
            if self.asked.necks && force == Vec3::zeros() {
                // Near enough for a neck, but there is none.
                continue;
            }
            let (mut ends, mut force) = ([row[0] as u64, row[1] as u64], force);
            if ends[0] >= self.first {
                // The force on the grain is wanted.
                ends.swap(0, 1);
                force = -force;
            }
            if !now.is_free(ends[0]) && !now.is_free(ends[1]) {
                continue;
            }
            let i = particle(now, ends[0])?;
            let (centre, radius, j, wall) = match ends[1].checked_sub(self.first) {
                None => {
                    let other = particle(now, ends[1])?;
                    (other.position, other.radius, other.id, false)
                }
                Some(sphere) => {
                    let (wall, centre, radius) =
                        self.spheres.get(sphere as usize).copied().ok_or_else(|| {
                            Ended::Wrong(format!("contacts: atom {} is no wall sphere of the scene", ends[1]))
                        })?;
                    (now.setup.walls[wall].motion.pose(now.time).position(&centre), radius, wall as u32, true)
                }
            };
            let apart = nearest(now.setup, i.position - centre);
            let distance = apart.norm();
            let normal = apart.try_normalize(0.0).unwrap_or_else(Vec3::zeros);
            let reach = i.radius + radius;
            let (point, _) = wrapped(now.setup, i.position - normal * (i.radius * distance / reach));
            all.push(ContactRecord {
                point,
                normal,
                force,
                overlap: reach - distance,
                i: i.id,
                j,
                wall,
                work: 0.0,
            });
        }
        Ok(())
    }

    fn touches(&self, touches: &Block, now: &Now, all: &mut Vec<ContactRecord>) -> Result<(), Ended> {
        for row in touches.rows() {
            if !now.is_free(row[0] as u64) {
                continue;
            }
            let i = particle(now, row[0] as u64)?;
            for (at, (index, _)) in row[1..].chunks_exact(AT_PLANE).zip(&self.asked.fixes) {
                let WallShape::Plane(plane) = &now.setup.walls[*index].shape else { continue };
                if at[0] == 0.0 {
                    continue;
                }
                let pose = now.setup.walls[*index].motion.pose(now.time);
                let distance = (i.position - pose.position(&plane.point)).dot(&plane.normal);
                all.push(ContactRecord {
                    point: wrapped(now.setup, i.position - plane.normal * distance).0,
                    normal: plane.normal,
                    force: Vec3::new(at[1], at[2], at[3]),
                    overlap: i.radius - distance,
                    i: i.id,
                    j: *index as u32,
                    wall: true,
                    work: 0.0,
                });
            }
        }
        Ok(())
    }
}

/// Forces on walls from the contacts of a frame.
pub fn on_walls(contacts: &[ContactRecord], setup: &Setup, time: f64) -> Vec<WallForce> {
    let still = |w: &dem::setup::Wall| WallForce {
        force: Vec3::zeros(),
        shift: w.motion.pose(time).shift(),
        contacts: 0,
        servo: None,
    };
    let mut forces: Vec<WallForce> = setup.walls.iter().map(still).collect();
    for contact in contacts.iter().filter(|c| c.wall) {
        let wall = &mut forces[contact.j as usize];
        wall.force -= contact.force;
        wall.contacts += 1;
    }
    forces
}

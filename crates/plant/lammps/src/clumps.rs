//! Rigid clumps: `fix rigid/small`, a molecule each, with mass, centre and inertia from the scene.
//!
//! ```text
//! bodies.info    number of a body, its mass, centre of mass, inertia, velocity and angular momentum: spheres that overlap do not falsify them
//! frames         a body is where its members are: two directions between them give its orientation
//! ```
//!
//! m* of a contact has the mass of the whole body on both engines. Members on one line show no turn about it: that is integrated from frame to frame.

use crate::error::Refusal;
use dem::ClumpState;
use dem::setup::{Body, ClumpShape, ContactLaw, Particle, Setup};
use geom::Vec3;
use nalgebra::{Matrix3, Rotation3, UnitQuaternion};
use std::io::{self, Write};

/// A turn between two frames of which the part about the line of a rod is not well known [rad].
const FAR: f64 = 0.5;
/// Members are on one line if none is farther from it than this share of their distance [–].
const ON_LINE: f64 = 1e-6;

/// Whether a scene has clumps at the start.
pub fn any(setup: &Setup) -> bool {
    !setup.clumps.placed.is_empty()
}

/// What LAMMPS cannot do with clumps.
pub fn refused(setup: &Setup) -> Vec<Refusal> {
    let (mut all, clumps) = (Vec::new(), &setup.clumps);
    if !clumps.entries.is_empty() {
        let why = "LAMMPS makes no rigid bodies during a run";
        all.push(Refusal::new(
            "clumps that come in",
            why,
            "place them with [[fill]] or [[body]], or use dem-run",
        ));
    }
    if clumps.placed.is_empty() {
        return all;
    }
    if !setup.outlets.is_empty() {
        let why = "LAMMPS takes spheres out one by one, not a clump as a whole";
        all.push(Refusal::new("outlet with clumps", why, "leave the outlet out, or use dem-run"));
    }
    let placed = |k: u32| clumps.placed.iter().any(|body| body.shape == k);
    for (_, shape) in (0..).zip(&clumps.shapes).filter(|(k, s)| s.spheres.len() < 2 && placed(*k)) {
        let why = "a rigid body of LAMMPS has two spheres or more";
        all.push(Refusal::new(
            format!("clump '{}'", shape.name),
            why,
            "use spheres ([[fill]] without clump)",
        ));
    }
    let of_clump = |law: &&ContactLaw| {
        let material = |m: u16| (0..).zip(&clumps.shapes).any(|(k, s)| s.material == m && placed(k));
        material(law.between.0) || material(law.between.1)
    };
    for law in setup.contacts.iter().filter(of_clump) {
        let given = |key: &&&str| law.number(key).is_some_and(|value| value > 0.0);
        let turning = ["rolling_resistance", "twisting_resistance"];
        for key in turning.iter().filter(given) {
            let why =
                "its dashpot of LAMMPS has one number for all, which would depend on the mass of the clump";
            all.push(Refusal::new(
                format!("{key} with clumps"),
                why,
                "leave it out: clumps lock by their shape",
            ));
        }
        if given(&&"tangential_damping") && !given(&&"normal_damping") {
            let why = "it is a share of the normal dashpot, which depends on the mass of the clump";
            all.push(Refusal::new(
                "tangential_damping with clumps",
                why,
                "give normal_damping, too, or leave it out",
            ));
        }
    }
    all
}

/// Adds the members of all clumps to the particles of a setup.
pub fn add_members(setup: &mut Setup) {
    let mut members = Vec::with_capacity(setup.clumps.members());
    for body in &setup.clumps.placed {
        let shape = &setup.clumps.shapes[body.shape as usize];
        let spheres = shape.spheres_at(body.position, &body.orientation, body.scale);
        members.extend((body.id..).zip(spheres).map(|(id, (position, radius))| {
            let velocity = body.velocity + body.spin.cross(&(position - body.position));
            Particle { id, material: shape.material, radius, position, velocity, spin: body.spin }
        }));
    }
    setup.particles.extend(members);
}

/// Clumps by the ids of their members, numbered from 1 as LAMMPS has them.
pub struct Numbers(Vec<(u32, u32)>);

impl Numbers {
    pub fn new(setup: &Setup) -> Numbers {
        let size = |b: &Body| setup.clumps.shapes[b.shape as usize].spheres.len() as u32;
        let mut all: Vec<(u32, u32)> = setup.clumps.placed.iter().map(|b| (b.id, size(b))).collect();
        all.sort_unstable();
        Numbers(all)
    }

    /// The clump of a particle; 0: none.
    pub fn of(&self, id: u32) -> usize {
        let before = self.0.partition_point(|(first, _)| *first <= id);
        let last = self.0[..before].last().filter(|(first, count)| id - first < *count);
        last.map_or(0, |_| before)
    }
}

/// Inertia about the centre, in space [kg·m²].
fn inertia(setup: &Setup, body: &Body, orientation: &UnitQuaternion<f64>) -> Matrix3<f64> {
    let shape = &setup.clumps.shapes[body.shape as usize];
    let turn = (orientation * shape.frame).to_rotation_matrix();
    let size = setup.materials[shape.material as usize].density * body.scale.powi(5);
    turn.matrix() * Matrix3::from_diagonal(&(Vec3::from(shape.inertia) * size)) * turn.matrix().transpose()
}

fn mass(setup: &Setup, body: &Body) -> f64 {
    let shape = &setup.clumps.shapes[body.shape as usize];
    shape.mass(body.scale, setup.materials[shape.material as usize].density)
}

/// Writes the file of bodies, whose velocity is higher by `more` [m/s] than in the scene.
///
/// # Errors
/// A write that fails.
pub fn write(setup: &Setup, more: &Vec3, out: &mut impl Write) -> io::Result<()> {
    let numbers = Numbers::new(setup);
    writeln!(
        out,
        "# number, mass, centre, Ixx Iyy Izz Ixy Ixz Iyz, velocity, angular momentum, images: SI units"
    )?;
    writeln!(out, "{}", setup.clumps.placed.len())?;
    for body in &setup.clumps.placed {
        let moments = inertia(setup, body, &body.orientation);
        let (x, images) = crate::places::wrapped(setup, body.position);
        let (v, momentum) = (body.velocity + more, moments * body.spin);
        write!(out, "{} {:?}", numbers.of(body.id), mass(setup, body))?;
        let tensor = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(|at| moments[at]);
        let all = x.iter().chain(&tensor).chain(&v).chain(&momentum);
        all.into_iter().try_for_each(|value| write!(out, " {value:?}"))?;
        let [i, j, k] = images;
        writeln!(out, " {i} {j} {k}")?;
    }
    Ok(())
}

/// Commands that make the bodies; `bodies` names the file.
pub fn commands(setup: &Setup) -> String {
    let (g, size) = (setup.gravity, setup.gravity.norm());
    let fall = format!(
        "fix fall bodies gravity {size:?} vector {:?} {:?} {:?} disable # by the mass of the body, not of its members\n",
        g.x, g.y, g.z
    );
    let (fall, by) = if size > 0.0 { (fall.as_str(), " gravity fall") } else { ("", "") };
    format!(
        "\n# rigid clumps: members of one exert no forces on each other\nneigh_modify exclude molecule/intra bodies\n\
         {fall}fix bodies bodies rigid/small molecule infile ${{bodies}}{by}\n"
    )
}

/// How far LAMMPS must look for the members of a body [m].
pub fn extent(setup: &Setup) -> f64 {
    let of = |b: &Body| 2.0 * b.scale * setup.clumps.shapes[b.shape as usize].reach();
    setup.clumps.placed.iter().map(of).fold(0.0, f64::max)
}

/// A clump, from frame to frame.
struct Tracked {
    body: Body,
    mass: f64,
    /// Where members are in the frame that the shape was given in [m].
    arms: Vec<Vec3>,
    /// Members that give, with the first one, two directions; one if all are on one line.
    seen: (usize, Option<usize>),
}

/// Clumps as frames have them.
pub struct Tracker<'a> {
    setup: &'a Setup,
    all: Vec<Tracked>,
    time: f64,
    /// Whether a rod was found that turns too far between two frames.
    told: bool,
    /// What the user should know of it.
    pub warning: Option<String>,
}

impl<'a> Tracker<'a> {
    /// At the start.
    pub fn new(setup: &'a Setup) -> Tracker<'a> {
        let mut all: Vec<Tracked> = setup.clumps.placed.iter().map(|b| Tracked::new(setup, b)).collect();
        all.sort_by_key(|t| t.body.id);
        Tracker { setup, all, time: 0.0, told: false, warning: None }
    }

    /// At a frame, of all particles by id.
    pub fn at(&mut self, time: f64, particles: &[Particle]) -> Vec<ClumpState> {
        let (setup, since) = (self.setup, time - self.time);
        self.time = time;
        let mut states = Vec::with_capacity(self.all.len());
        for tracked in &mut self.all {
            let first = particles.partition_point(|p| p.id < tracked.body.id);
            // Members are not lost: the frame has all particles.
            let Some(members) = particles.get(first..first + tracked.arms.len()) else { continue };
            tracked.follow(setup, members, since);
            let by = tracked.body.spin.norm() * since;
            if tracked.seen.1.is_none() && by > FAR && !self.told {
                self.told = true;
                self.warning = Some(format!(
                    "body {}, whose members are on one line, turns by {by:.1} rad between two frames at t = {} s: its angle about that line is followed from frame to frame, and is not exact: use a shorter output.every",
                    tracked.body.id,
                    geom::Shown(time)
                ));
            }
            let Tracked { body, mass, arms, .. } = &*tracked;
            states.push(ClumpState {
                id: body.id,
                shape: body.shape,
                members: arms.len() as u32,
                scale: body.scale,
                mass: *mass,
                position: crate::places::wrapped(setup, body.position).0,
                orientation: body.orientation,
                velocity: body.velocity,
                spin: body.spin,
                angular_momentum: inertia(setup, body, &body.orientation) * body.spin,
            });
        }
        states
    }
}

impl Tracked {
    fn new(setup: &Setup, body: &Body) -> Tracked {
        let shape: &ClumpShape = &setup.clumps.shapes[body.shape as usize];
        let arms: Vec<Vec3> = shape.spheres.iter().map(|(c, _)| shape.frame * (c * body.scale)).collect();
        let from = |k: usize| arms[k] - arms[0];
        let most = |size: &dyn Fn(usize) -> f64| {
            (0..arms.len()).max_by(|a, b| size(*a).total_cmp(&size(*b))).unwrap_or(0)
        };
        let far = most(&|k| from(k).norm());
        let axis = from(far).try_normalize(0.0).unwrap_or_else(Vec3::zeros);
        let aside = |k: usize| from(k).cross(&axis).norm();
        let second = Some(most(&aside)).filter(|k| aside(*k) > ON_LINE * from(far).norm());
        Tracked { body: *body, mass: mass(setup, body), arms, seen: (far, second) }
    }

    /// Takes its state from its members, a time [s] after the last frame.
    fn follow(&mut self, setup: &Setup, members: &[Particle], since: f64) {
        let apart = |k: usize| crate::places::nearest(setup, members[k].position - members[0].position);
        let (spin, (far, second)) = (members[0].spin, self.seen);
        let turn = match second {
            Some(second) => {
                let there = triad(apart(far), apart(second));
                let own = triad(self.arms[far] - self.arms[0], self.arms[second] - self.arms[0]);
                UnitQuaternion::from_rotation_matrix(&(there * own.inverse()))
            }
            None => {
                let before = self.body.orientation;
                let axis = before * (self.arms[far] - self.arms[0]).normalize();
                let now = apart(far).normalize();
                let about = 0.5 * (self.body.spin.dot(&axis) + spin.dot(&now)) * since;
                let tilted = UnitQuaternion::rotation_between(&axis, &now).unwrap_or_default();
                tilted * dem::spun(&(axis * about)) * before
            }
        };
        let arm = turn * self.arms[0];
        self.body.position = members[0].position - arm;
        self.body.velocity = members[0].velocity - spin.cross(&arm);
        (self.body.orientation, self.body.spin) = (turn, spin);
    }
}

/// Axes of which the first is along `a`, and the second in the plane of both.
fn triad(a: Vec3, b: Vec3) -> Rotation3<f64> {
    let first = a.normalize();
    let third = first.cross(&b).normalize();
    Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[first, third.cross(&first), third]))
}

//! What arithmetic a step takes of a contact and of a bond: counted by a lane that notes each operation, as a test of the table that
//! `make -C pipelines bench` computes its limits from.
//!
//! Only what the results need is counted, and each product or sum once: a compiler leaves out the rest. So is what is the same for all contacts.

#[path = "../../examples/limits/kernels.rs"]
#[expect(dead_code, reason = "the example reads the rest of the table")]
mod kernels;

use crate::model::BondedPair;
use crate::model::bonds::springs::packed;
use crate::passes::bonds::lanes::{BondChunk, Instant};
use crate::setup::BondNumbers;
use crate::state::Particles;
use geom::Vec3;
use kernels::{BOND, KERNELS, Kernel};
use laws::contact::contact_loop::{act, gather};
use laws::contact::{Batch, StepInputs, Sums, WrenchBuffer, WrenchSlicesMut};
use laws::effects::*;
use laws::simd::compiled::Job;
use laws::simd::{BLOCK, Indices, Lane, Layout, Row, Row4};
use laws::space::cell::Cell;
use nalgebra::UnitQuaternion;
use std::cell::RefCell;
use std::collections::{BTreeSet, HashMap};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// What makes a number of others.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Operation {
    /// A sum or a difference.
    Add,
    Subtract,
    Multiply,
    Divide,
    Root,
    /// Comparison, choice, minimum, sign: not counted.
    Choose(u8),
    /// Read from a table, by its bits: all that is read here differs.
    Read(u64),
    /// A constant, by its bits.
    Constant(u64),
}

/// All operations so far: each once.
#[derive(Default)]
struct Notes {
    number_of: HashMap<(Operation, Vec<usize>), usize>,
    all: Vec<(Operation, Vec<usize>)>,
    /// What is written or asked for.
    wanted: BTreeSet<usize>,
}

thread_local! {
    static NOTES: RefCell<Notes> = RefCell::default();
}

fn note(operation: Operation, of: &[usize]) -> usize {
    NOTES.with_borrow_mut(|notes| {
        let key = (operation, of.to_vec());
        let next = notes.all.len();
        let number = *notes.number_of.entry(key.clone()).or_insert(next);
        if number == next {
            notes.all.push(key);
        }
        number
    })
}

fn want(number: usize) {
    NOTES.with_borrow_mut(|notes| notes.wanted.insert(number));
}

/// Adds and multiplies, divisions, roots that what was wanted takes, of what differs between contacts.
fn counts() -> [usize; 3] {
    NOTES.with_borrow_mut(|notes| {
        let Notes { all, wanted, .. } = std::mem::take(notes);
        let mut varies = vec![false; all.len()];
        for (k, (operation, of)) in all.iter().enumerate() {
            varies[k] = matches!(operation, Operation::Read(_)) || of.iter().any(|&o| varies[o]);
        }
        let (mut open, mut seen): (Vec<usize>, _) = (wanted.into_iter().collect(), BTreeSet::new());
        let mut counts = [0; 3];
        while let Some(k) = open.pop() {
            if !varies[k] || !seen.insert(k) {
                continue;
            }
            match all[k].0 {
                Operation::Add | Operation::Subtract | Operation::Multiply => counts[0] += 1,
                Operation::Divide => counts[1] += 1,
                Operation::Root => counts[2] += 1,
                Operation::Choose(_) | Operation::Read(_) | Operation::Constant(_) => {}
            }
            open.extend(&all[k].1);
        }
        counts
    })
}

/// A number, and the operation that made it.
#[derive(Clone, Copy)]
struct Counted(f64, usize);

/// A truth value of it.
#[derive(Clone, Copy)]
struct Truth(bool, usize);

macro_rules! operator {
    ($trait:ident, $name:ident, $operation:ident) => {
        impl $trait for Counted {
            type Output = Counted;
            fn $name(self, o: Counted) -> Counted {
                Counted(self.0.$name(o.0), note(Operation::$operation, &[self.1, o.1]))
            }
        }
    };
}
operator!(Add, add, Add);
operator!(Sub, sub, Subtract);
operator!(Mul, mul, Multiply);
operator!(Div, div, Divide);

impl Neg for Counted {
    type Output = Counted;
    fn neg(self) -> Counted {
        Counted(-self.0, note(Operation::Choose(0), &[self.1]))
    }
}

fn read(x: f64) -> Counted {
    Counted(x, note(Operation::Read(x.to_bits()), &[]))
}

fn write<const N: usize>(columns: [Counted; N], to: &mut [f64]) {
    for (to, column) in to.iter_mut().zip(columns) {
        want(column.1);
        *to = column.0;
    }
}

impl Lane for Counted {
    const WIDTH: usize = 1;
    const TINY: f64 = f64::TINY;
    type Mask = Truth;
    type Wide = Counted;

    fn narrow(wide: Counted) -> Counted {
        wide
    }
    fn overlap(_: Counted, reach: Counted, distance: Counted) -> Counted {
        reach - distance
    }
    fn splat(x: f64) -> Counted {
        Counted(x, note(Operation::Constant(x.to_bits()), &[]))
    }
    fn load(from: &[f64]) -> Counted {
        read(from[0])
    }
    fn store(self, to: &mut [f64]) {
        write([self], to);
    }
    fn sqrt(self) -> Counted {
        Counted(self.0.sqrt(), note(Operation::Root, &[self.1]))
    }
    fn min(self, o: Counted) -> Counted {
        Counted(self.0.min(o.0), note(Operation::Choose(1), &[self.1, o.1]))
    }
    fn max(self, o: Counted) -> Counted {
        Counted(self.0.max(o.0), note(Operation::Choose(2), &[self.1, o.1]))
    }
    fn gt(self, o: Counted) -> Truth {
        Truth(self.0 > o.0, note(Operation::Choose(3), &[self.1, o.1]))
    }
    fn select(mask: Truth, yes: Counted, no: Counted) -> Counted {
        Counted(if mask.0 { yes.0 } else { no.0 }, note(Operation::Choose(4), &[mask.1, yes.1, no.1]))
    }
    fn both(a: Truth, b: Truth) -> Truth {
        Truth(a.0 & b.0, note(Operation::Choose(5), &[a.1, b.1]))
    }
    fn any(mask: Truth) -> bool {
        want(mask.1);
        mask.0
    }
    fn rows(table: &[Row], indices: Indices) -> [Counted; 8] {
        f64::rows(table, indices).map(read)
    }
    fn rows4(table: &[Row4], indices: Indices) -> [Counted; 4] {
        f64::rows4(table, indices).map(read)
    }
    fn store_rows(columns: [Counted; 8], to: &mut [f64]) {
        write(columns, to);
    }
    fn store_rows4(columns: [Counted; 4], to: &mut [f64]) {
        write(columns, to);
    }
}

/// Two spheres in contact that slide and roll on each other a little.
fn spheres() -> ([Row; 2], [Row4; 2]) {
    let rows = [
        Row([0.1, 0.2, 0.3, 0.01, 0.01, -0.02, 0.03, 1e3]),
        Row([0.11, 0.205, 0.31, 0.009, -0.03, 0.01, -0.02, 1.2e3]),
    ];
    (rows, [Row4([1.0, 2.0, -3.0, 0.0]), Row4([-1.5, 0.5, 2.5, 0.0])])
}

/// What a contact takes that lasts and sticks.
fn contact<E: Effect>(effect: &E) -> [usize; 3] {
    let (rows, spins) = spheres();
    let layout = Layout { rotates: E::ROTATES, single: false };
    let step = StepInputs { dt: 1e-5, ahead: 0.0, overlap_limit: 0.5, rows: &rows, spins: &spins, layout };
    let mut history: Vec<f64> = (0..E::HISTORY * BLOCK).map(|k| 1e-9 * (k as f64 + 0.1)).collect();
    let mut batch = Batch {
        partners: (&rows, &spins),
        i: &[0],
        j: &[1],
        history: &mut history,
        active: &mut [true],
        sums: Sums::default(),
        both: false,
        kept: WrenchSlicesMut::default(),
        patch: &[],
        each: WrenchSlicesMut::default(),
        ledger: &mut [],
    };
    let ends = gather::<Counted, E>(&step, &batch, 0);
    let mut buffer = WrenchBuffer::<f64>::new();
    let (acts, deep) = act::<Counted, E, f64, false>(effect, &step, &mut batch, &mut buffer, (0, 0), ends);
    assert!(acts && !deep);
    counts()
}

/// What a bond takes.
fn bond() -> [usize; 3] {
    let ([a, b], spins) = spheres();
    let mut particles = Particles::new(true);
    (particles.rows, particles.spins) = (vec![a, b], spins.to_vec());
    let turns = [Row4([0.011, 0.012, 0.013, 0.99978]), Row4([0.021, 0.022, 0.023, 0.99927])];
    let numbers = BondNumbers {
        axis: Vec3::new(-0.01, -0.005, -0.0101).normalize(),
        reference: UnitQuaternion::from_euler_angles(0.01, 0.02, 0.03),
        size: [0.015, 0.009],
        share: 0.45,
        stiffness: [1e5, 4e4, 1.7, 1.3],
        lag: 1e-6,
        moments: 0.8,
        at_ends: false,
        strength: [1e9, 1.1e9, 0.3],
        replaces_contact: true,
    };
    let springs = [packed(&numbers)];
    let at = Instant::of(&particles, &turns, &Cell::at_rest([None; 3]));
    let pulls = &mut [Default::default()];
    BondChunk { at: &at, pairs: &[BondedPair::new([0, 1])], springs: &springs, pulls }.run::<Counted>();
    counts()
}

#[test]
fn the_table_has_what_contacts_and_bonds_take() {
    let material = Material { name: "a".to_owned(), density: 2500.0, young: 1e7, poisson: 0.3 };
    let elastic = Elastic::of(&material, &material);
    let mut law = ContactLaw::new((0, 0), "hooke").with("restitution", 0.5).with("stiffness", 1e4);
    let mut found = Vec::new();
    let mut pair = |law: &ContactLaw, count: &dyn Fn(&Pair) -> [usize; 3]| {
        let compliance = Compliance { clumps: 1.0, springs: 1.0 };
        let damping = Damping::exact(0.5);
        found.push(count(&Pair { law, elastic, compliance, damping }));
    };
    pair(&law, &|p| contact(&Hooke::new(p)));
    law.set("sliding_friction", 0.5);
    pair(&law, &|p| contact(&(Hooke::new(p), SlidingFriction::<f64>::new(p))));
    law.set("rolling_resistance", 0.1);
    pair(&law, &|p| contact(&(Hooke::new(p), (SlidingFriction::<f64>::new(p), RollingResistance::new(p)))));
    law.set("twisting_resistance", 0.1);
    let sliding = |p: &Pair| SlidingFriction::<Friction>::new(p);
    let turning = |p: &Pair| (RollingResistance::new(p), TwistingResistance::new(p));
    pair(&law, &|p| contact(&((Hooke::new(p), None::<Cohesion>), (sliding(p), turning(p)))));
    law.set("cohesion_energy_density", 1e3);
    pair(&law, &|p| contact(&((Hooke::new(p), Some(Cohesion::new(p))), (sliding(p), turning(p)))));
    found.push(bond());
    let table: Vec<[usize; 3]> = KERNELS
        .iter()
        .chain([&BOND])
        .map(|k: &Kernel| [k.operations as usize, k.divisions as usize, k.roots as usize])
        .collect();
    assert_eq!(found, table);
}

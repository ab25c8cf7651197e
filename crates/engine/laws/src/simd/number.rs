//! Numbers of contacts, in double or in single precision: history, wrenches, and sums of wrenches.
//!
//! All are kept in columns of words of eight bytes, so that one kind of column does for both precisions: a word holds one number, or two.

use crate::simd::{BLOCK, Lane};
use core::ops::{AddAssign, SubAssign};

/// A number as it is kept.
pub trait Number: Copy + Default + AddAssign + SubAssign + Send + Sync {
    /// How many a word holds.
    const IN_A_WORD: usize;
    /// In double precision.
    fn wide(self) -> f64;
    /// What words hold.
    fn of(words: &[f64]) -> &[Self];
    /// The same, mutable.
    fn of_mut(words: &mut [f64]) -> &mut [Self];
    /// The first numbers of a slice as lanes.
    fn load<R: Lane>(from: &[Self]) -> R;
    /// Writes lanes to the first numbers of a slice.
    fn store<R: Lane>(lanes: R, to: &mut [Self]);
    /// Writes columns as rows of eight.
    fn store_rows<R: Lane>(columns: [R; 8], to: &mut [Self]);
    /// Writes columns as rows of four.
    fn store_rows4<R: Lane>(columns: [R; 4], to: &mut [Self]);
}

macro_rules! number {
    ($number:ident, $in_a_word:literal, $load:ident, $store:ident, $store_rows:ident, $store_rows4:ident) => {
        impl Number for $number {
            const IN_A_WORD: usize = $in_a_word;
            #[inline(always)]
            fn wide(self) -> f64 {
                f64::from(self)
            }
            #[inline(always)]
            fn of(words: &[f64]) -> &[$number] {
                bytemuck::must_cast_slice(words)
            }
            #[inline(always)]
            fn of_mut(words: &mut [f64]) -> &mut [$number] {
                bytemuck::must_cast_slice_mut(words)
            }
            #[inline(always)]
            fn load<R: Lane>(from: &[$number]) -> R {
                R::$load(from)
            }
            #[inline(always)]
            fn store<R: Lane>(lanes: R, to: &mut [$number]) {
                lanes.$store(to);
            }
            #[inline(always)]
            fn store_rows<R: Lane>(columns: [R; 8], to: &mut [$number]) {
                R::$store_rows(columns, to);
            }
            #[inline(always)]
            fn store_rows4<R: Lane>(columns: [R; 4], to: &mut [$number]) {
                R::$store_rows4(columns, to);
            }
        }
    };
}
number!(f64, 1, load, store, store_rows, store_rows4);
number!(f32, 2, load_single, store_single, store_rows_single, store_rows4_single);

/// How the numbers of contacts are kept in a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Layout {
    /// Whether wrenches have moments.
    pub rotates: bool,
    /// Whether numbers are kept in single precision.
    pub single: bool,
}

/// Expands to a call for the numbers `$T` of a layout, and for whether its wrenches have moments: `$ROTATES`.
#[macro_export]
macro_rules! with_layout {
    ($layout:expr, $T:ident, $ROTATES:ident => $call:expr) => {
        $crate::with_layout!(@ $layout, $T, $ROTATES => $call; (false, false, f64), (false, true, f64), (true, false, f32), (true, true, f32))
    };
    (@ $layout:expr, $T:ident, $ROTATES:ident => $call:expr; $(($single:literal, $rotates:literal, $number:ty)),*) => {
        match ($layout.single, $layout.rotates) {
            $(($single, $rotates) => {
                type $T = $number;
                const $ROTATES: bool = $rotates;
                $call
            })*
        }
    };
}

/// Numbers of a force, with or without the moment of its tangential part.
pub const fn numbers_of_force(rotates: bool) -> usize {
    if rotates { FORCE_AND_MOMENT } else { FORCE }
}

impl Layout {
    /// Words of so many numbers.
    #[inline(always)]
    fn words(self, numbers: usize) -> usize {
        let single = usize::from(self.single);
        (numbers + single) >> single
    }

    /// Words of a force, with its moment where anything rotates.
    #[inline(always)]
    pub fn force(self) -> usize {
        self.words(numbers_of_force(self.rotates))
    }

    /// Words of a torque.
    #[inline(always)]
    pub fn torque(self) -> usize {
        self.words(TORQUE)
    }

    /// Words of the history of one contact with so many columns.
    #[inline(always)]
    pub fn history(self, columns: usize) -> usize {
        self.words(columns)
    }

    /// Which of the numbers behind `first` words is column `column` of the history of the contact after `k` others, with so many columns.
    pub fn history_at(self, first: usize, k: usize, column: usize, columns: usize) -> usize {
        let block = first + k / BLOCK * BLOCK * self.history(columns);
        (block << usize::from(self.single)) + column * BLOCK + k % BLOCK
    }

    /// Number `at` of some words.
    #[inline(always)]
    pub fn get(self, words: &[f64], at: usize) -> f64 {
        if self.single { f32::of(words)[at].wide() } else { words[at] }
    }

    /// Puts number `at` of some words.
    #[inline(always)]
    pub fn put(self, words: &mut [f64], at: usize, x: f64) {
        if self.single { f32::of_mut(words)[at] = x as f32 } else { words[at] = x }
    }

    /// Whether all numbers are finite.
    pub fn are_finite(self, words: &[f64]) -> bool {
        if self.single {
            f32::of(words).iter().all(|x| x.is_finite())
        } else {
            words.iter().all(|x| x.is_finite())
        }
    }
}

/// Numbers of a force without rotation: force on i and a pad.
pub const FORCE: usize = 4;
/// With rotation: force on i, a pad, n × F_t times distance over reach (the moment on a particle of radius −1), a pad.
pub const FORCE_AND_MOMENT: usize = 8;
/// Numbers of a torque: on i, and a pad.
pub const TORQUE: usize = 4;

/// In which precision contacts are computed. Positions and velocities are always in double precision: within a plant of metres, a position in
/// single precision would be coarser than the overlap of two grains at rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Precision {
    /// Double precision.
    #[default]
    Double,
    /// Contacts in single precision; their history, and sums of wrenches, in double precision.
    Mixed,
    /// All of that in single precision.
    Single,
}

impl Precision {
    /// Its name in scenes.
    pub fn name(self) -> &'static str {
        match self {
            Precision::Double => "f64",
            Precision::Mixed => "mixed",
            Precision::Single => "f32",
        }
    }
}

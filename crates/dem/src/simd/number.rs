//! Numbers that are computed of contacts, in double or in single precision: what they remember, their loads, and the sums of these.
//!
//! All are kept in columns of words of eight bytes, so that one kind of column does for both precisions: a word holds one number, or two.

use crate::simd::{BLOCK, Lane};
use std::ops::{AddAssign, SubAssign};

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

impl Number for f64 {
    const IN_A_WORD: usize = 1;
    #[inline(always)]
    fn wide(self) -> f64 {
        self
    }
    #[inline(always)]
    fn of(words: &[f64]) -> &[f64] {
        words
    }
    #[inline(always)]
    fn of_mut(words: &mut [f64]) -> &mut [f64] {
        words
    }
    #[inline(always)]
    fn load<R: Lane>(from: &[f64]) -> R {
        R::load(from)
    }
    #[inline(always)]
    fn store<R: Lane>(lanes: R, to: &mut [f64]) {
        lanes.store(to);
    }
    #[inline(always)]
    fn store_rows<R: Lane>(columns: [R; 8], to: &mut [f64]) {
        R::store_rows(columns, to);
    }
    #[inline(always)]
    fn store_rows4<R: Lane>(columns: [R; 4], to: &mut [f64]) {
        R::store_rows4(columns, to);
    }
}

impl Number for f32 {
    const IN_A_WORD: usize = 2;
    #[inline(always)]
    fn wide(self) -> f64 {
        f64::from(self)
    }
    #[inline(always)]
    fn of(words: &[f64]) -> &[f32] {
        bytemuck::must_cast_slice(words)
    }
    #[inline(always)]
    fn of_mut(words: &mut [f64]) -> &mut [f32] {
        bytemuck::must_cast_slice_mut(words)
    }
    #[inline(always)]
    fn load<R: Lane>(from: &[f32]) -> R {
        R::load_single(from)
    }
    #[inline(always)]
    fn store<R: Lane>(lanes: R, to: &mut [f32]) {
        lanes.store_single(to);
    }
    #[inline(always)]
    fn store_rows<R: Lane>(columns: [R; 8], to: &mut [f32]) {
        R::store_rows_single(columns, to);
    }
    #[inline(always)]
    fn store_rows4<R: Lane>(columns: [R; 4], to: &mut [f32]) {
        R::store_rows4_single(columns, to);
    }
}

/// How what is computed of contacts is kept in a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Layout {
    /// Whether loads have moments.
    pub rotates: bool,
    /// Whether numbers are kept in single precision.
    pub single: bool,
}

/// Expands to a call for the numbers `$T` of a layout, and for whether its wrenches have moments: `$ROTATES`.
macro_rules! as_kept {
    ($form:expr, $T:ident, $ROTATES:ident => $call:expr) => {
        $crate::simd::number::as_kept!(@ $form, $T, $ROTATES => $call; (false, false, f64), (false, true, f64), (true, false, f32), (true, true, f32))
    };
    (@ $form:expr, $T:ident, $ROTATES:ident => $call:expr; $(($single:literal, $rotates:literal, $number:ty)),*) => {
        match ($form.single, $form.rotates) {
            $(($single, $rotates) => {
                type $T = $number;
                const $ROTATES: bool = $rotates;
                $call
            })*
        }
    };
}
pub(crate) use as_kept;

/// Numbers of a load, with or without a moment.
pub const fn of_a_load(rotates: bool) -> usize {
    if rotates { FORCE_AND_MOMENT } else { FORCE }
}

impl Layout {
    /// Words of so many numbers.
    #[inline(always)]
    fn words(self, numbers: usize) -> usize {
        let single = usize::from(self.single);
        (numbers + single) >> single
    }

    /// Words of a load.
    #[inline(always)]
    pub fn load(self) -> usize {
        self.words(of_a_load(self.rotates))
    }

    /// Words of a couple.
    #[inline(always)]
    pub fn torque(self) -> usize {
        self.words(COUPLE)
    }

    /// Words of the memory of one contact that has so many columns.
    #[inline(always)]
    pub fn memory(self, columns: usize) -> usize {
        self.words(columns)
    }

    /// Which of the numbers behind `first` words is column `column` of the memory of the contact after `k` others, with so many columns.
    pub fn memory_at(self, first: usize, k: usize, column: usize, columns: usize) -> usize {
        let block = first + k / BLOCK * BLOCK * self.memory(columns);
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

    /// The first three numbers of load `place`.
    pub fn force(self, loads: &[f64], place: usize) -> geom::Vec3 {
        let first = place * of_a_load(self.rotates);
        geom::Vec3::new(self.get(loads, first), self.get(loads, first + 1), self.get(loads, first + 2))
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

/// Numbers of a load without rotation: force on i and a pad.
pub const FORCE: usize = 4;
/// With rotation: force on i, a pad, n × F_t times distance over reach (the moment on a particle of radius −1), a pad.
pub const FORCE_AND_MOMENT: usize = 8;
/// Numbers of a couple: on i, and a pad.
pub const COUPLE: usize = 4;

/// In which precision contacts are computed; places and velocities are always in double precision. Within a plant of metres a place in single
/// precision would be coarser than the overlap of two grains at rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Precision {
    /// Double precision.
    #[default]
    Double,
    /// What happens in a contact in single precision; what it remembers, and the sums of loads, in double precision.
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

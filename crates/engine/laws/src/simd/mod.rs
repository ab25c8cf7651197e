//! Lanes: one contact, or several at a time, computed by the same source with the same bits.
//!
//! Arithmetic is in double precision, or, for what happens in a contact, in single precision: positions are subtracted in
//! double precision first, so that nothing is lost far from the origin.
//!
//! Only operations that IEEE 754 rounds the same way everywhere: +, −, ×, ÷, √, comparison. No fused
//! multiply-add and no reassociation, so a wide lane equals the scalar one bit for bit.
//!
//! Every function on lanes is marked `#[inline(always)]`, so that it is compiled for the wide registers of the loop that calls it; closures cannot be
//! marked. A function that is not inlined calls another for each operation and takes several times as long.

use alloc::vec;
use alloc::vec::Vec;
pub mod aligned;
pub mod compiled;
pub mod number;
mod root;
pub mod scalar;
pub mod turn;
pub mod two;
mod vectors;
#[cfg(target_arch = "x86_64")]
pub mod x86;
#[cfg(target_arch = "x86_64")]
pub mod x86_single;

pub use aligned::Aligned;
pub use number::{FORCE, FORCE_AND_MOMENT, Layout, Number, Precision, TORQUE};
pub use root::cube_root;
pub use scalar::Each;
pub use turn::Turn;
pub use two::Two;

use core::ops::{Add, Deref, DerefMut, Div, Mul, Neg, Sub};
use serde::{Deserialize, Serialize};

/// Contacts are stored in blocks of this many, whatever the width of the lanes that compute them.
pub const BLOCK: usize = 8;

/// State that a contact needs of a particle: x, y, z, radius, vx, vy, vz, 1/m; one cache line, and never two.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[repr(C, align(64))]
pub struct Row(pub [f64; 8]);

/// A vector and a fourth number, within one cache line.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[repr(C, align(32))]
pub struct Row4(pub [f64; 4]);

macro_rules! behaves_as {
    ($row:ty, $array:ty) => {
        impl Deref for $row {
            type Target = $array;
            #[inline(always)]
            fn deref(&self) -> &$array {
                &self.0
            }
        }
        impl DerefMut for $row {
            #[inline(always)]
            fn deref_mut(&mut self) -> &mut $array {
                &mut self.0
            }
        }
    };
}

behaves_as!(Row, [f64; 8]);
behaves_as!(Row4, [f64; 4]);

/// Asks for an entry of a table that will soon be read, whether or not there is one; it changes nothing.
#[inline(always)]
pub fn fetch<T>(table: &[T], at: usize) {
    #[cfg(target_arch = "x86_64")]
    x86::fetch(table.as_ptr().wrapping_add(at));
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (table, at);
}

/// Which rows of a table are read: all of them within it, which is checked once for several tables of as many rows.
#[derive(Clone, Copy)]
pub struct Indices<'a> {
    of: &'a [u32],
    /// All are below this.
    rows: usize,
}

impl<'a> Indices<'a> {
    /// Places in tables of so many rows.
    ///
    /// # Panics
    /// Where one lies beyond.
    #[inline(always)]
    pub fn within(of: &'a [u32], rows: usize) -> Indices<'a> {
        let end = rows.min(u32::MAX as usize) as u32;
        // Without a branch for each.
        assert!(of.iter().fold(true, |all, &k| all & (k < end)));
        Indices { of, rows }
    }

    /// Those from number `first` on.
    #[inline(always)]
    pub fn from(self, first: usize) -> Indices<'a> {
        Indices { of: &self.of[first..], ..self }
    }
}

/// `WIDTH` numbers that are computed at once.
pub trait Lane:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// How many contacts; divides [`BLOCK`].
    const WIDTH: usize;
    /// Smallest square that is divided by.
    const TINY: f64;
    /// One truth value each.
    type Mask: Copy;
    /// The same many numbers in double precision: rows are read and subtracted so.
    type Wide: Lane;

    /// Rounded to the precision of this lane.
    fn narrow(wide: Self::Wide) -> Self;
    /// r_i + r_j − distance, where `gap` is (r_i + r_j)² − distance² in double precision, and `reach` r_i + r_j.
    fn overlap(gap: Self, reach: Self, distance: Self) -> Self;

    /// The same number everywhere.
    fn splat(x: f64) -> Self;
    /// The first `WIDTH` numbers of `from`.
    fn load(from: &[f64]) -> Self;
    /// Writes the first `WIDTH` numbers of `to`.
    fn store(self, to: &mut [f64]);
    /// Square root.
    fn sqrt(self) -> Self;
    /// The smaller; `other` where either is NaN.
    fn min(self, other: Self) -> Self;
    /// The larger; `other` where either is NaN.
    fn max(self, other: Self) -> Self;
    /// self > other; false for NaN.
    fn gt(self, other: Self) -> Self::Mask;
    /// `yes` where the mask holds, else `no`.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// Both.
    fn both(a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// Whether any lane holds.
    fn any(mask: Self::Mask) -> bool;
    /// Columns of the rows at the first `WIDTH` indices.
    fn rows(table: &[Row], indices: Indices) -> [Self; 8];
    /// The same for rows of four.
    fn rows4(table: &[Row4], indices: Indices) -> [Self; 4];
    /// Writes columns as `WIDTH` rows of eight.
    fn store_rows(columns: [Self; 8], to: &mut [f64]);
    /// Writes columns as `WIDTH` rows of four.
    fn store_rows4(columns: [Self; 4], to: &mut [f64]);

    /// As [`Lane::load`], from single precision.
    #[inline(always)]
    fn load_single(from: &[f32]) -> Self {
        let mut wide = [0.0; BLOCK];
        wide.iter_mut().zip(&from[..Self::WIDTH]).for_each(|(w, x)| *w = f64::from(*x));
        Self::load(&wide)
    }
    /// As [`Lane::store`], rounded to single precision.
    #[inline(always)]
    fn store_single(self, to: &mut [f32]) {
        let mut wide = [0.0; BLOCK];
        self.store(&mut wide);
        round(&wide[..Self::WIDTH], to);
    }
    /// As [`Lane::store_rows`], rounded to single precision.
    #[inline(always)]
    fn store_rows_single(columns: [Self; 8], to: &mut [f32]) {
        let mut wide = [0.0; 8 * BLOCK];
        Self::store_rows(columns, &mut wide);
        round(&wide[..8 * Self::WIDTH], to);
    }
    /// As [`Lane::store_rows4`], rounded to single precision.
    #[inline(always)]
    fn store_rows4_single(columns: [Self; 4], to: &mut [f32]) {
        let mut wide = [0.0; 4 * BLOCK];
        Self::store_rows4(columns, &mut wide);
        round(&wide[..4 * Self::WIDTH], to);
    }
}

#[inline(always)]
fn round(from: &[f64], to: &mut [f32]) {
    to[..from.len()].iter_mut().zip(from).for_each(|(x, w)| *x = *w as f32);
}

/// Four numbers of one particle that are computed at once.
pub trait Four: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// Reads four numbers.
    fn read(from: &[f64; 4]) -> Self;
    /// Writes them.
    fn write(self, to: &mut [f64; 4]);
    /// The same number four times.
    fn all(x: f64) -> Self;
}

/// A vector of lanes.
#[derive(Clone, Copy)]
pub struct V<R> {
    /// x.
    pub x: R,
    /// y.
    pub y: R,
    /// z.
    pub z: R,
}

impl<R: Lane> V<R> {
    /// The vector of three lanes.
    #[inline(always)]
    pub fn new(x: R, y: R, z: R) -> V<R> {
        V { x, y, z }
    }
    /// Rounded to the precision of the lane.
    #[inline(always)]
    pub fn narrow(wide: V<R::Wide>) -> V<R> {
        V::new(R::narrow(wide.x), R::narrow(wide.y), R::narrow(wide.z))
    }
    /// Zero.
    #[inline(always)]
    pub fn zero() -> V<R> {
        V::new(R::splat(0.0), R::splat(0.0), R::splat(0.0))
    }
    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, o: V<R>) -> R {
        self.x * o.x + self.y * o.y + self.z * o.z
    }
    /// Vector product.
    #[inline(always)]
    pub fn cross(self, o: V<R>) -> V<R> {
        V::new(self.y * o.z - self.z * o.y, self.z * o.x - self.x * o.z, self.x * o.y - self.y * o.x)
    }
    /// Times a number.
    #[inline(always)]
    pub fn scale(self, s: R) -> V<R> {
        V::new(self.x * s, self.y * s, self.z * s)
    }
    /// `yes` where the mask holds, else `no`.
    #[inline(always)]
    pub fn select(mask: R::Mask, yes: V<R>, no: V<R>) -> V<R> {
        V::new(R::select(mask, yes.x, no.x), R::select(mask, yes.y, no.y), R::select(mask, yes.z, no.z))
    }
}

impl<R: Lane> Add for V<R> {
    type Output = V<R>;
    #[inline(always)]
    fn add(self, o: V<R>) -> V<R> {
        V::new(self.x + o.x, self.y + o.y, self.z + o.z)
    }
}

impl<R: Lane> Sub for V<R> {
    type Output = V<R>;
    #[inline(always)]
    fn sub(self, o: V<R>) -> V<R> {
        V::new(self.x - o.x, self.y - o.y, self.z - o.z)
    }
}

/// The lanes that this machine computes with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Width {
    /// One contact at a time: the reference.
    Scalar,
    /// Four at a time.
    Avx2,
    /// Eight at a time.
    Avx512,
}

impl Width {
    /// All that this machine can run, widest last.
    pub fn available() -> Vec<Width> {
        let mut widths = vec![Width::Scalar];
        #[cfg(target_arch = "x86_64")]
        {
            if std::is_x86_feature_detected!("avx2") {
                widths.push(Width::Avx2);
            }
            if std::is_x86_feature_detected!("avx512f") && std::is_x86_feature_detected!("avx512dq") {
                widths.push(Width::Avx512);
            }
        }
        widths
    }

    /// The widest that this machine can run.
    pub fn best() -> Width {
        Width::available().pop().unwrap_or(Width::Scalar)
    }
}

//! Numbers in whole cache lines.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::{Deref, DerefMut};

/// Numbers of a cache line.
const LINE: usize = 8;

/// Zeros at first, beginning at the start of a cache line.
#[derive(Debug, Default)]
pub struct Aligned {
    margin: Vec<f64>,
    first: usize,
    len: usize,
}

impl Aligned {
    /// `len` zeros.
    pub fn zeros(len: usize) -> Aligned {
        if len == 0 {
            return Aligned::default();
        }
        let margin = vec![0.0; len + LINE];
        let first = margin.as_ptr().align_offset(LINE * size_of::<f64>()).min(LINE);
        Aligned { margin, first, len }
    }

    /// `len` zeros, in the same memory where there are so many.
    pub fn clear(&mut self, len: usize) {
        match self.len == len {
            true => self.fill(0.0),
            false => *self = Aligned::zeros(len),
        }
    }
}

impl Clone for Aligned {
    fn clone(&self) -> Aligned {
        let mut copy = Aligned::zeros(self.len);
        copy.copy_from_slice(self);
        copy
    }
}

impl Deref for Aligned {
    type Target = [f64];
    fn deref(&self) -> &[f64] {
        &self.margin[self.first..self.first + self.len]
    }
}

impl DerefMut for Aligned {
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.margin[self.first..self.first + self.len]
    }
}

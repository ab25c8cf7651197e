//! Grains at t = 0: sizes, materials, and places that none shares.

pub(in crate::plan) mod fill;
pub(in crate::plan) mod grading;
pub(in crate::plan) mod images;
pub(in crate::plan) mod kept_clear;
pub(in crate::plan) mod lattice;
pub(in crate::plan) mod obstacles;
pub(in crate::plan) mod one_per_cell;
pub(in crate::plan) mod packing;
pub(in crate::plan) mod particles;
pub(in crate::plan) mod random;
pub(in crate::plan) mod sizes;

//! Laws, hard cases and whole pipelines, tested from outside.

pub mod setups;

//! What is tested: a sample, its grains, and what the user asks for.

pub mod grains;
pub mod request;
pub mod sample;

//! The engine, called from Rust: its effects, together and alone, particles, walls and precisions.

mod belts;
mod clumps;
mod concave;
mod effects_adhesion;
mod effects_forces;
mod effects_together;
mod fluid;
mod local_damping;
mod meshes;
mod mounts;
mod precision;
mod records;
mod servo;
mod servo_shear;
mod sleep;
mod strained_cell;
mod wall_sums;

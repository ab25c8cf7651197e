//! Mechanics: contacts, forces, stress, strain and energy of particles.

pub mod coordination;
pub mod domain;
pub mod energy;
pub mod fabric;
pub mod forces;
pub mod plane_force;
pub mod settling;
pub mod strain;
pub mod stress;

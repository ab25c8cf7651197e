//! How things look: camera, colours, fields and scales.

pub(crate) mod camera;
pub(crate) mod classes;
pub(crate) mod colour;
pub(crate) mod field;
pub(crate) mod scale;
pub(crate) mod wall_scale;

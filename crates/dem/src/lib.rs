//! dem

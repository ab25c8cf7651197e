//! Laws, hard cases and whole pipelines, tested from outside.

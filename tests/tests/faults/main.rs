//! Faults from outside: killed runs, full disks, closed pipes, files that were cut or changed.

mod attack;
mod attacked;
mod disk;
mod files;
mod found;
mod kill;
mod pipes;
mod samples;

//! The tools, as a user calls them, and the pages and files that go with them.

mod bad_inputs;
mod chain;
mod clump_scenes;
mod contact_numbers;
mod cost;
mod cost_curve;
mod dem_run;
mod docs;
mod every_key;
mod every_option;
mod layout;
mod ledger_line;
mod limits;
mod measure;
mod outputs;
mod pipelines;
mod plants;
mod python;
mod readme;
mod real_clouds;
mod scans;
mod scene;
mod sinter_box;
mod streams;
mod view_in_chromium;
mod walls_told;

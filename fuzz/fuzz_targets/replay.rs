//! A run with crossings, made an inlet.
#![no_main]
use stages::replay::{Replay, replay};
use std::io::Cursor;
use stream::mcap::{Compression, Provenance};

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let source = Box::new(Cursor::new(grainpipe_fuzz::without_crcs(data)));
    let how = (Provenance::default(), Compression::None.into());
    let _ = replay(vec![("run".into(), source)], &Replay::default(), Vec::new(), how);
});

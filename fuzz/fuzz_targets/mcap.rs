//! MCAP: all events of a stream, walls and inlets, the last checkpoint of a run.
#![no_main]
use std::io::Cursor;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    for bytes in [data.to_vec(), grainpipe_fuzz::without_crcs(data)] {
        for event in stream::mcap::Reader::hashed(&bytes[..]) {
            let _ = event;
        }
        let _ = scene::Checkpoint::last("run", &bytes[..]);
        let _ = scene::Input::open("input", Box::new(Cursor::new(bytes)));
    }
});

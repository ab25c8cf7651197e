//! MCAP: all events of a stream, walls and inlets, the last checkpoint of a run.
#![no_main]
use std::io::Cursor;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    // As it is, and with CRCs out of the way, which the reader does not check then.
    for event in stream::mcap::Reader::hashed(data) {
        let _ = event;
    }
    let bytes = grainpipe_fuzz::without_crcs(data);
    let _ = run::Checkpoint::last("run", &bytes[..]);
    let _ = scene::Input::open("input", Box::new(Cursor::new(bytes)));
});

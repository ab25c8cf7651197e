//! A run as the measures read it.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let bytes = grainpipe_fuzz::without_crcs(data);
    let mut run = measure::Run::default();
    for event in stream::mcap::Reader::new(&bytes[..]).flatten() {
        let _ = run.take(event);
    }
});

//! The body of a checkpoint, under a head whose length and hash are right.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let _ = stream::state::decode::<run::Checkpoint>(data);
    let _ = stream::state::decode::<run::Checkpoint>(&grainpipe_fuzz::state_of(data));
});

//! A replay passes on what a run has written so far, while the run is still being written.

use dem::setup::{Particle, Zone};
use geom::Vec3;
use record::metadata::SIZES;
use record::topic::{CROSSINGS, WATERMARK};
use record::{Sizes, Watermark};
use stages::outlet::crossing::{CrossingRow, to_table};
use stages::replay::{Replay, replay};
use std::collections::BTreeMap;
use std::io::{Read, Write};
use std::sync::{Arc, Mutex};
use stream::mcap::{Compression, Event, Provenance, Reader, Writer};

/// Bytes that can be looked at while they are written.
#[derive(Clone, Default)]
struct Shared(Arc<Mutex<Vec<u8>>>);

impl Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.lock().unwrap().extend_from_slice(bytes);
        Ok(bytes.len())
    }
    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

impl Shared {
    /// Crossings and the last watermark that a reader can see now.
    fn seen(&self) -> (usize, f64) {
        let bytes = self.0.lock().unwrap().clone();
        let (mut rows, mut until) = (0, -1.0);
        for event in Reader::new(bytes.as_slice()).map_while(Result::ok) {
            match event {
                Event::Points { topic, table, .. } if topic == CROSSINGS => rows += table.rows(),
                Event::Bytes { topic, data, .. } if topic == WATERMARK => {
                    until = Watermark::read("test", &data).unwrap().until;
                }
                _ => {}
            }
        }
        (rows, until)
    }
}

/// A run that comes in two parts; between them it looks at what the replay has written.
struct Halting {
    parts: Vec<Vec<u8>>,
    out: Shared,
    between: Arc<Mutex<Option<(usize, f64)>>>,
}

impl Read for Halting {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        if self.parts.first().is_some_and(Vec::is_empty) {
            self.parts.remove(0);
            self.between.lock().unwrap().get_or_insert(self.out.seen());
        }
        let Some(part) = self.parts.first_mut() else { return Ok(0) };
        let n = buffer.len().min(part.len());
        buffer[..n].copy_from_slice(&part[..n]);
        part.drain(..n);
        Ok(n)
    }
}

fn row(time: f64, id: u32) -> CrossingRow {
    let zero = Vec3::zeros();
    let particle = Particle {
        id,
        material: 0,
        radius: 0.01,
        position: zero,
        velocity: Vec3::new(0.0, 0.0, -1.0),
        spin: zero,
    };
    CrossingRow { time, outlet: 0, particle, contacts: 0, clump: None, turn: None, cluster: 0 }
}

/// A run with two crossings until 1 s and one until 2 s, as the parts that were flushed.
fn run() -> Vec<Vec<u8>> {
    let bytes = Shared::default();
    let mut writer = Writer::new(bytes.clone(), &Provenance::default()).unwrap();
    let one = |value: String| BTreeMap::from([("0".to_owned(), value)]);
    let zone = Zone::new("0,0,0,0,0,-1".parse().unwrap(), 0.03);
    writer.metadata("scene", BTreeMap::from([("toml".to_owned(), String::new())])).unwrap();
    writer.metadata("materials", one(r#"{"name":"m","density":1000.0}"#.into())).unwrap();
    writer.metadata(SIZES, Sizes { smallest: 0.01, largest: 0.01 }.to_map()).unwrap();
    writer.metadata("outlets", one(serde_json::to_string(&zone).unwrap())).unwrap();
    let mut write = |rows: &[CrossingRow], until: f64| {
        writer.points(CROSSINGS, 0, "world", to_table(rows)).unwrap();
        writer.bytes(WATERMARK, "json", 0, &Watermark { until }.to_json()).unwrap();
        writer.flush_chunk().unwrap();
    };
    write(&[row(0.5, 1), row(0.75, 2)], 1.0);
    let first = bytes.0.lock().unwrap().len();
    write(&[row(1.5, 3)], 2.0);
    writer.finish().unwrap();
    let all = bytes.0.lock().unwrap().clone();
    vec![all[..first].to_vec(), all[first..].to_vec()]
}

#[test]
fn crossings_and_watermarks_are_passed_on_at_once() {
    let (out, between) = (Shared::default(), Arc::new(Mutex::new(None)));
    let source = Halting { parts: run(), out: out.clone(), between: between.clone() };
    let how = (Provenance::default(), Compression::None.into());
    let (done, _) =
        replay(vec![("run".into(), Box::new(source))], &Replay::default(), out.clone(), how).unwrap();
    assert_eq!(
        *between.lock().unwrap(),
        Some((2, 0.5)),
        "both crossings, and a watermark from the first crossing"
    );
    assert_eq!(out.seen(), (3, 1.5));
    assert_eq!((done.particles, done.start, done.last), (3, 0.5, 1.0));
}

#[test]
fn a_run_that_breaks_off_is_an_error_after_what_it_wrote_was_passed_on() {
    let out = Shared::default();
    let source = Halting { parts: run()[..1].to_vec(), out: out.clone(), between: Default::default() };
    let how = (Provenance::default(), Compression::None.into());
    let failed = replay(vec![("run".into(), Box::new(source))], &Replay::default(), out.clone(), how);
    assert!(failed.is_err());
    assert_eq!(out.seen(), (2, 0.5));
    let whole = Reader::new(out.0.lock().unwrap().as_slice()).all(|e| e.is_ok());
    assert!(!whole, "it does not look whole");
}

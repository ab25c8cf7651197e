//! Pages that say what the code says: tables that the code prints.

use grainpipe_tests::tree::root;
use std::{env, fs};

/// What stands before and after a table that is printed.
const MARKS: [&str; 2] = ["<!-- printed from the effects' descriptions -->\n", "<!-- until here -->\n"];

/// docs/reference/scene.md has the effects and keys of contacts as the engine describes them; GRAINPIPE_WRITE_DOCS=1 writes them there.
#[test]
fn the_page_on_scenes_has_every_effect_and_key() {
    let path = root().join("docs/reference/scene.md");
    let text = fs::read_to_string(&path).expect("the page is there");
    let (before, rest) = text.split_once(MARKS[0]).expect("the first mark");
    let (table, after) = rest.split_once(MARKS[1]).expect("the second mark");
    let wanted = dem::effects::tables();
    if env::var_os("GRAINPIPE_WRITE_DOCS").is_some() {
        fs::write(&path, [before, MARKS[0], &wanted, MARKS[1], after].concat())
            .expect("the page can be written");
    } else {
        assert!(
            table == wanted,
            "docs/reference/scene.md is behind: run this test with GRAINPIPE_WRITE_DOCS=1\n{wanted}"
        );
    }
}

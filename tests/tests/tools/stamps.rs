//! Pages whose numbers long commands print: whether today's programs would print the same.

use grainpipe_tests::tools::line;
use grainpipe_tests::tree::root;
use std::collections::BTreeSet;

/// Scene, time and files of each stamp, as the program that writes the page has them.
fn stamped() -> Vec<String> {
    let source = root().join("pipelines/studies/src/bin/stages_study/page.rs");
    let text = std::fs::read_to_string(source).unwrap();
    let named = text.lines().filter(|l| l.contains(": &str = \"") && l.contains(".toml"));
    named.map(|l| l.split('"').nth(1).unwrap().to_owned()).collect()
}

#[test]
fn a_page_of_stages_is_that_of_these_scenes_and_of_what_these_programs_make_of_them() {
    let page = std::fs::read_to_string(root().join("docs/evidence/stages.md")).unwrap();
    let found: BTreeSet<&str> = page.lines().filter(|l| l.starts_with("<!-- stamp: ")).collect();
    let folder = root().join("pipelines/stages");
    let today: Vec<String> = stamped()
        .iter()
        .map(|words| {
            let done = line(&folder, &format!("./stamp.sh {words}"));
            assert_eq!(done.code, 0, "{words}: {}", done.stderr);
            String::from_utf8(done.stdout).unwrap().trim().to_owned()
        })
        .collect();
    let today: BTreeSet<&str> = today.iter().map(String::as_str).collect();
    assert_eq!(found, today, "SEEDS=3 make -C pipelines stages-study writes the page again");
}

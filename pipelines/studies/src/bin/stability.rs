//! Writes a page of what tests found, with its plots beside it: `stability FINDINGS.jsonl PAGE.md TITLE [PART…]`.
//!
//! PAGE-orders.svg holds the orders of convergence, PAGE-curves.svg the curves, where there are any.

use grainpipe_tests::{page, plots};
use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [findings, file, title, parts @ ..] = words.as_slice() else {
        eprintln!("stability: usage: stability FINDINGS.jsonl PAGE.md TITLE [PART…]");
        return ExitCode::from(2);
    };
    match write(findings, Path::new(file), title, parts) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("stability: {why}");
            ExitCode::FAILURE
        }
    }
}

fn write(findings: &str, file: &Path, title: &str, parts: &[String]) -> Result<(), String> {
    let text = std::fs::read_to_string(findings).map_err(|why| format!("{findings}: {why}"))?;
    let page = page::read(&text, parts)?;
    if page.parts.is_empty() {
        return Err(format!("{findings}: no finding: did the tests run with GRAINPIPE_FINDINGS={findings}?"));
    }
    let stem = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let beside = |what: &str| file.with_file_name(format!("{stem}-{what}.svg"));
    let mut out = format!(
        "# {title}\n\nThis page lists what the tests check and the largest deviation that they found. `make -C pipelines {stem}` writes it.\n\nLaws are tested with time steps that resolve them. The default step is 0.5 of the critical step;\n[accuracy.md](accuracy.md) shows what a coarser step costs.\n\n| column | meaning |\n|---|---|\n| tried on | number of variants, and the one with the worst result |\n| worst found | the result nearest to its limit; for wrong input, the message that refuses it |\n| limit | the test fails beyond this |\n| order (expected) | order of convergence in the time step, measured and expected |\n"
    );
    let orders = plots::orders(&page, &beside("orders"), "step (over contact time or period)")?;
    let curves = plots::curves(&page, &beside("curves"))?;
    out += &page.tables();
    for (what, picture) in [("orders", orders), ("curves", curves)] {
        if let Some(picture) = picture {
            let name = beside(what);
            std::fs::write(&name, picture).map_err(|why| format!("{}: {why}", name.display()))?;
            out += &format!("\n![{what}]({stem}-{what}.svg)\n");
        }
    }
    std::fs::write(file, out).map_err(|why| format!("{}: {why}", file.display()))
}

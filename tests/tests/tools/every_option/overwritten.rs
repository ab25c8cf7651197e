//! No option that names an output takes an input of the same call, whichever the tool: by the examples.

use super::examples::EXAMPLES;
use super::files::inputs;
use grainpipe_tests::tools::{line, program};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::process::Command;

/// Tools that read nothing.
const READS_NOTHING: [&str; 1] = ["chute-scan"];

/// The words of an example; what stands in quotes is one of them.
fn words(example: &str) -> Vec<&str> {
    let parts = example.split('\'').enumerate();
    parts
        .flat_map(|(k, part)| if k % 2 == 1 { vec![part] } else { part.split_whitespace().collect() })
        .collect()
}

/// The options of a tool that name what it writes: each in its spellings, by its description of itself.
fn outputs(tool: &str) -> Vec<Vec<String>> {
    let told = Command::new(program(tool)).arg("--describe-arguments").output().expect("it starts").stdout;
    let told: Value = serde_json::from_slice(&told).expect("JSON");
    let writes = told["arguments"].as_array().expect("a list").iter().filter(|a| a["writes"] == true);
    let spellings = |a: &Value| {
        let short = a["short"].as_str().map(|short| format!("-{short}"));
        short.into_iter().chain(a["long"].as_str().map(|long| format!("--{long}"))).collect()
    };
    writes.map(spellings).collect()
}

/// An example without one of its outputs, and the files that it reads.
fn without(
    output: &[String],
    outputs: &[Vec<String>],
    example: &str,
    folder: &Path,
) -> (String, Vec<String>) {
    let quoted = |word: &str| if word.contains(' ') { format!("'{word}'") } else { word.to_owned() };
    let (mut kept, mut read, mut all) = (Vec::new(), Vec::new(), words(example).into_iter());
    while let Some(word) = all.next() {
        let is_of = |options: &[String]| options.iter().any(|option| option == word);
        if outputs.iter().any(|options| is_of(options)) {
            let value = all.next().unwrap_or_default();
            if !is_of(output) {
                kept.extend([word, value].map(quoted));
            }
            continue;
        }
        let names = [Some(word), word.split_once('=').map(|(_, file)| file)];
        read.extend(
            names.into_iter().flatten().filter(|name| folder.join(name).is_file()).map(str::to_owned),
        );
        kept.push(quoted(word));
    }
    (kept.join(" "), read)
}

#[test]
fn an_input_is_not_an_output_in_any_option_of_any_tool() {
    let folder = inputs();
    let folder = folder.path();
    let tools: BTreeSet<&str> = EXAMPLES.iter().filter_map(|line| line.split(' ').next()).collect();
    let outputs: BTreeMap<&str, Vec<Vec<String>>> = tools.iter().map(|tool| (*tool, outputs(tool))).collect();
    let of = |example: &str| &outputs[example.split(' ').next().unwrap_or_default()];
    // What one example writes and another reads need not be made: a call is refused before it reads.
    for example in EXAMPLES {
        let words = words(example);
        for pair in words.windows(2).filter(|pair| of(example).iter().flatten().any(|o| o == pair[0])) {
            let file = folder.join(pair[1]);
            if file.extension().is_some() && !file.exists() {
                fs::write(file, "not read").unwrap();
            }
        }
    }
    let (mut untried, mut wrong) = (BTreeSet::new(), Vec::new());
    for tool in tools.iter().filter(|tool| !READS_NOTHING.contains(tool)) {
        let examples = || EXAMPLES.iter().filter(|example| example.split(' ').next() == Some(tool));
        for (output, option) in of(tool).iter().flat_map(|output| output.iter().map(move |o| (output, o))) {
            // One that conflicts with the others of an example is refused for that.
            let mut tried = 0;
            for example in examples() {
                let (call, read) = without(output, of(tool), example, folder);
                for file in read {
                    let before = fs::read(folder.join(&file)).unwrap();
                    let done = line(folder, &format!("{call} {option} ./{file}"));
                    if done.stderr.contains("cannot be used with")
                        || done.stderr.contains("were not provided")
                    {
                        continue;
                    }
                    tried += 1;
                    let flag = if option == "--output" { "-o" } else { option };
                    let said = done.stderr.contains(&format!("{flag} ./{file} is also an input"));
                    if done.code != 2 || !said || fs::read(folder.join(&file)).ok() != Some(before) {
                        wrong.push(format!("{call} {option} ./{file}: {}: {}", done.code, done.stderr));
                    }
                }
            }
            if tried == 0 {
                untried.insert(format!("{tool} {option}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{} wrong:\n{}", wrong.len(), wrong.join("\n"));
    assert!(untried.is_empty(), "tried with no input: {untried:#?}");
}

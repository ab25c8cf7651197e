//! The tool under test: its first argument says how it ends.

use anyhow::Context;
use cli::{Output, Report, Seed, Source, Stopped};
use std::{
    io::{Read, Write},
    process::ExitCode,
};
use stream::ply::Encoding;

/// Environment variable that turns the test program into this tool.
pub const SWITCH: &str = "GRAINPIPE_CLI_TEST_TOOL";

/// Tries every way to end
#[derive(clap::Parser)]
struct Args {
    action: String,
    #[arg(default_value = "-")]
    input: Source,
    #[command(flatten)]
    output: Output,
    #[command(flatten)]
    seed: Seed,
}

pub fn main() -> ExitCode {
    cli::run("cloud-test", |args: Args| {
        let report = Report::new("done").with("seed", args.seed.seed());
        match args.action.as_str() {
            "copy" => return copy(&args),
            "arguments" => println!("{:?}", cli::arguments()),
            "usage" => return Err(cli::usage("--spacing: 0 m: give more")),
            "flood" => {
                let mut out = args.output.open()?;
                loop {
                    out.write_all(&[7; 4096])?;
                }
            }
            action => {
                let mut out = args.output.open()?;
                out.write_all(&[7; 1_000_000])?;
                end(action)?;
                out.commit()?;
                if action == "stop" {
                    return Err(Stopped::error("particle 5: overlap 31 %", None, report));
                }
            }
        }
        Ok(report)
    })
}

fn end(action: &str) -> anyhow::Result<()> {
    match action {
        "write" => {
            let names =
                std::fs::read_dir(".")?.map(|e| e.map(|e| e.file_name().to_string_lossy().into_owned()));
            let names: Vec<String> = names.collect::<Result<_, _>>()?;
            eprintln!("during: {}", names.join(" "));
        }
        "fail" => return Err(anyhow::anyhow!("point 7: x is NaN: drop it").context("scan.ply")),
        "panic" => panic!("on purpose"),
        "hoard" => {
            let mut all = Vec::new();
            while all.len() < 64 {
                all.push(vec![7u8; 64 << 20]);
            }
            return Err(anyhow::anyhow!("{} pieces were given", all.len()));
        }
        // A program that the tool waits for: the signal that ends it is one to the tool, too.
        "helper" => {
            std::process::Command::new("sh").args(["-c", "kill -TERM $PPID"]).status()?;
            return Err(anyhow::anyhow!("the helper failed"));
        }
        "wait" => {
            std::io::stdin().read_to_end(&mut Vec::new())?;
        }
        _ => {}
    }
    Ok(())
}

/// Copies a PLY file.
fn copy(args: &Args) -> anyhow::Result<Report> {
    let ply = stream::ply::read(&mut args.input.open()?).with_context(|| args.input.to_string())?;
    let points = ply.elements.first().map_or(0, |vertices| vertices.table.rows());
    let mut out = args.output.open()?;
    stream::ply::write(&mut out, &ply, Encoding::BinaryLittleEndian)?;
    out.commit()?;
    Ok(Report::new(format!("{points} points"))
        .with("points", points)
        .with("threads", rayon::current_num_threads()))
}

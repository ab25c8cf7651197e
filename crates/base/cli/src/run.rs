//! How every tool starts and ends.

use crate::{
    OutPath, Report, Source, Stopped, clash, describe,
    exit::{self, code, one_line, reader_closed_the_pipe},
    invocation::{INVOCATION, Invocation, WARNINGS, warn},
    memory,
    output::OutputStream,
    signals,
    stderr::{say, say_lines},
    stdout,
};
use anyhow::Context;
use clap::{
    Arg, ArgMatches, Args as _, Command, FromArgMatches as _, builder::Resettable, parser::ValueSource,
};
use record::StopCause;
use serde_json::{Map, Value, json};
use std::{
    io::{ErrorKind, Write},
    num::NonZeroUsize,
    path::Path,
    process::ExitCode,
    time::Instant,
};
use stream::reads::Stop;

/// Options of every tool; [`run`] adds them, so a tool need not flatten them.
#[derive(Debug, Clone, Default, clap::Args)]
pub struct Common {
    /// Print errors only
    #[arg(short, long)]
    pub quiet: bool,
    /// Threads to use (default: all cores); the result is the same for any number
    #[arg(long, value_name = "N")]
    pub threads: Option<NonZeroUsize>,
    /// Write a report to FILE (JSON)
    #[arg(long, value_name = "FILE")]
    pub report: Option<OutPath>,
}

/// `--seed N`, for tools that use random numbers.
#[derive(Debug, Clone, Copy, Default, clap::Args)]
pub struct Seed {
    /// Seed of the random numbers; the same seed gives the same result [default: 0]
    #[arg(long = "seed", value_name = "N")]
    given: Option<u64>,
}

impl Seed {
    /// The seed.
    pub fn seed(&self) -> u64 {
        self.given.unwrap_or(0)
    }

    /// Refuses a seed where nothing is left to chance.
    ///
    /// # Errors
    /// A seed that was given.
    pub fn none(&self, by: &str) -> anyhow::Result<()> {
        match self.given {
            Some(_) => Err(crate::usage(format!("--seed: {by} leaves nothing to chance: leave it out"))),
            None => Ok(()),
        }
    }
}

/// Parses the arguments, runs `work`, reports, and turns every outcome into an exit code.
pub fn run<A: clap::Parser>(name: &'static str, work: impl FnOnce(A) -> anyhow::Result<Report>) -> ExitCode {
    let start = Instant::now();
    signals::size_limit_is_an_error();
    let print = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        // The standard library has no other word for a thread without memory for its second stack.
        if panic.location().is_some_and(|at| at.file().ends_with("stack_overflow.rs")) {
            memory::end(0);
        }
        print(panic);
    }));
    if describe::is_asked() {
        let written = writeln!(std::io::stdout(), "{}", describe::text(&command::<A>(name)));
        return ExitCode::from(u8::from(written.is_err()));
    }
    let matches = parsed(command::<A>(name)).unwrap_or_else(|e| refuse(name, &e));
    let (args, common) = match (A::from_arg_matches(&matches), Common::from_arg_matches(&matches)) {
        (Ok(args), Ok(common)) => (args, common),
        (Err(e), _) | (_, Err(e)) => refuse(name, &e.with_cmd(&command::<A>(name))),
    };
    let arguments = canonical(&command::<A>(name), &matches);
    let _ = INVOCATION.set(Invocation { tool: name, arguments, quiet: common.quiet });
    set_twice(&matches);
    let outcome = clash::refuse(&command::<A>(name), &matches)
        .and_then(|()| set_threads(&common))
        .and_then(|()| work(args));
    let (report, error) = match outcome {
        Ok(report) => (Some(report), None),
        Err(mut e) => (e.downcast_mut::<Stopped>().and_then(|s| s.report.take()), Some(e)),
    };
    let error = error.or_else(|| report.as_ref().and_then(|r| tell(name, r, &common, start).err()));
    let Some(error) = error else { return ExitCode::SUCCESS };
    signals::let_it_end();
    if code(&error) == exit::STOPPED
        && let Some(report) = &report
    {
        let _ = tell(name, report, &common, start);
    }
    if code(&error) == exit::STOPPED {
        let cause = error.downcast_ref::<Stopped>().and_then(|stopped| stopped.cause);
        let (stopped, signal) = (one_line(&error), cause == Some(StopCause::Signal));
        // What keeps the record says so itself where it cannot be written.
        let _ = stream::reads::note_stop(Stop { stopped, signal });
    }
    if !reader_closed_the_pipe(&error) {
        say(&format!("{name}: {}", one_line(&error)));
    }
    ExitCode::from(code(&error))
}

/// Parses the arguments in a pool of one thread: a value that reads a mesh would start the pool of all before `--threads` is known.
fn parsed(command: Command) -> Result<ArgMatches, clap::Error> {
    match rayon::ThreadPoolBuilder::new().num_threads(1).build() {
        Ok(pool) => pool.install(|| command.try_get_matches()),
        Err(_) => command.try_get_matches(),
    }
}

/// The tool's command line, with the options of every tool and the project's version.
fn command<A: clap::Parser>(name: &'static str) -> Command {
    let command = A::command().name(name).version(env!("CARGO_PKG_VERSION"));
    // -1 is a wrong spacing, not an unknown flag.
    let command = command.allow_negative_numbers(true);
    if command.get_arguments().any(|a| a.get_id() == "quiet") {
        return command;
    }
    // Adding arguments also replaces the tool's documentation by that of their group.
    let (about, long_about) = (command.get_about().cloned(), command.get_long_about().cloned());
    Common::augment_args(command).about(Resettable::from(about)).long_about(Resettable::from(long_about))
}

/// More threads than any machine has cores: a typing error.
const MOST_THREADS: usize = 4096;

/// Messages of number parsers, and what they mean.
const PLAIN: [(&str, &str); 5] = [
    ("invalid float literal", "not a number: give it in SI units without the unit, such as 0.012"),
    ("invalid digit found in string", "not a whole number"),
    ("number too large to fit in target type", "this number is too large"),
    ("cannot parse integer from empty string", "a number is missing"),
    ("number would be zero for non-zero type", "give at least 1"),
];

/// Ends the tool: help and version as they are, wrong usage with the tool's name, which a pipe of several needs.
fn refuse(name: &str, error: &clap::Error) -> ! {
    if !error.use_stderr() {
        help(name, error);
    }
    let mut text = error.render().to_string();
    if error.kind() == clap::error::ErrorKind::InvalidUtf8 {
        text = not_text().unwrap_or(text);
    }
    for (program, people) in PLAIN {
        text = text.replace(program, people);
    }
    say_lines(&format!("{name}: {}", text.strip_prefix("error: ").unwrap_or(&text)));
    std::process::exit(i32::from(exit::USAGE))
}

/// What to do about the first argument that is not text; names of inputs and outputs may be any bytes.
fn not_text() -> Option<String> {
    let argument = std::env::args_os().skip(1).find(|argument| argument.to_str().is_none())?;
    Some(format!(
        "argument '{}': is not valid UTF-8: rename the file, or give it as text",
        argument.display()
    ))
}

/// Of a key that is set several times the last value counts.
fn set_twice(matches: &ArgMatches) {
    let Ok(Some(sets)) = matches.try_get_many::<String>("set") else { return };
    let values: Vec<(&str, &str)> = sets.filter_map(|set| set.split_once('=')).collect();
    for (n, (key, value)) in values.iter().enumerate() {
        if let Some((_, last)) = values[n + 1..].iter().find(|(other, _)| other.trim() == key.trim()) {
            warn(&format!(
                "--set {key}={value}: is set again, and {key}={last} counts: leave one of them out"
            ));
        }
    }
}

/// Prints help or version and ends the tool.
fn help(name: &str, error: &clap::Error) -> ! {
    let printed = if stdout::is_closed() { Err(ErrorKind::NotConnected.into()) } else { error.print() };
    let failed = printed.err().filter(|e| e.kind() != ErrorKind::BrokenPipe);
    if failed.is_some() {
        say(&format!("{name}: stdout is closed or cannot be written to"));
    }
    std::process::exit(i32::from(failed.is_some()))
}

/// Threads that are always allowed, also on a small machine; more than these and [`SHARE`] for each core only wait for each other.
const ENOUGH: usize = 64;
/// Environment variable that sets the number of threads where `--threads` does not.
const VARIABLE: &str = "RAYON_NUM_THREADS";
/// Threads for each core.
const SHARE: usize = 4;

/// The calling thread is one of them, so that no work is handed to others and back. It follows that threads which a tool starts itself
/// must not wait for work of this pool while the main thread waits for them.
fn set_threads(common: &Common) -> anyhow::Result<()> {
    let cores = std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    // Rayon takes any number from its variable, and starts as many.
    let variable = || std::env::var(VARIABLE).ok()?.parse().ok();
    let (name, given) = match (common.threads, variable().filter(|n: &usize| *n > 0)) {
        (Some(given), _) => ("--threads", given.get()),
        (None, Some(given)) => (VARIABLE, given),
        (None, None) => ("--threads", cores),
    };
    if common.threads.is_some() && given > MOST_THREADS {
        return Err(exit::usage(format!("--threads {given}: give at most {MOST_THREADS}")));
    }
    let most = ENOUGH.max(SHARE * cores);
    if given > most {
        warn(&format!(
            "{name} {given}: {most} threads are used: this machine has {cores} cores, and more only wait"
        ));
    }
    let threads = given.min(most);
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .use_current_thread()
        .build_global()
        .with_context(|| format!("--threads {threads}: cannot start them"))
}

/// Whether an option changes nothing in the result.
fn is_silent(argument: &Arg) -> bool {
    let id = argument.get_id().as_str();
    ["quiet", "threads", "device", "progress", "help", "version"].contains(&id) || clash::is_output(argument)
}

/// See [`arguments`].
fn canonical(command: &Command, matches: &ArgMatches) -> Vec<String> {
    let mut list = Vec::new();
    for argument in command.get_arguments() {
        let id = argument.get_id().as_str();
        let given = matches!(matches.try_contains_id(id), Ok(true))
            && matches.value_source(id) == Some(ValueSource::CommandLine);
        if !given || is_silent(argument) || matches.try_get_many::<Source>(id).is_ok() {
            continue;
        }
        let prefix = argument.get_long().map(|long| format!("--{long}")).unwrap_or_default();
        for value in matches.get_raw(id).into_iter().flatten() {
            let value = value.to_string_lossy();
            list.push(match (prefix.is_empty(), argument.get_action().takes_values()) {
                (true, _) => value.into_owned(),
                (false, true) => format!("{prefix}={value}"),
                (false, false) => prefix.clone(),
            });
        }
    }
    list
}

/// Writes `--report` and the summary line.
fn tell(name: &str, report: &Report, common: &Common, start: Instant) -> anyhow::Result<()> {
    if let Some(path) = &common.report {
        write_report(path, name, report, start).context("--report")?;
    }
    if !common.quiet && !report.summary.is_empty() {
        say(&format!("{name}: {}", report.summary));
    }
    Ok(())
}

fn write_report(path: &Path, name: &str, report: &Report, start: Instant) -> anyhow::Result<()> {
    let mut all = Map::new();
    all.insert("tool".into(), json!(name));
    all.insert("version".into(), json!(env!("CARGO_PKG_VERSION")));
    all.insert(
        "arguments".into(),
        json!(std::env::args_os().skip(1).map(|a| a.to_string_lossy().into_owned()).collect::<Vec<_>>()),
    );
    all.insert("seconds".into(), json!(start.elapsed().as_secs_f64()));
    all.insert("peak_memory_bytes".into(), peak_memory().map_or(Value::Null, |b| json!(b)));
    all.insert("summary".into(), json!(report.summary));
    all.insert("warnings".into(), WARNINGS.lock().map_or(Value::Null, |all| json!(*all)));
    all.extend(report.fields.clone());
    let mut out = OutputStream::file(path)?;
    serde_json::to_writer_pretty(&mut out, &Value::Object(all)).map_err(std::io::Error::from)?;
    out.write_all(b"\n")?;
    out.commit()
}

/// Peak memory of this process [B], if the system reports it (Linux: VmHWM).
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    line.split_whitespace().nth(1)?.parse::<u64>().ok().map(|kib| 1024 * kib)
}

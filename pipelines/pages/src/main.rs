//! Man pages, and completions for bash, zsh and fish, from what the tools say of their arguments.

use anyhow::{Context, bail};
use clap::{Arg, ArgAction, Command, builder::PossibleValue};
use clap_complete::{Shell, generate_to};
use serde::Deserialize;
use std::{fs, path::Path};

/// What a tool prints for `--describe-arguments` (crates/base/cli/src/describe.rs).
#[derive(Deserialize)]
struct Tool {
    name: String,
    version: Option<String>,
    about: Option<String>,
    long_about: Option<String>,
    after_help: Option<String>,
    arguments: Vec<Argument>,
}

#[derive(Deserialize)]
struct Argument {
    id: String,
    long: Option<String>,
    aliases: Vec<String>,
    short: Option<char>,
    help: Option<String>,
    takes_value: bool,
    value_names: Vec<String>,
    values: Vec<Choice>,
    defaults: Vec<String>,
    required: bool,
    repeats: bool,
}

#[derive(Deserialize)]
struct Choice {
    name: String,
    help: Option<String>,
}

/// Shells, and where they look for completions below a prefix.
const SHELLS: [(Shell, &str); 3] = [
    (Shell::Bash, "bash-completion/completions"),
    (Shell::Zsh, "zsh/site-functions"),
    (Shell::Fish, "fish/vendor_completions.d"),
];

fn main() -> anyhow::Result<()> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [out, tools @ ..] = &words[..] else { bail!("usage: pages FOLDER TOOL…") };
    for tool in tools {
        let tool = described(tool).with_context(|| tool.clone())?;
        pages(&tool, Path::new(out)).with_context(|| format!("{out}: {}", tool.name))?;
    }
    Ok(())
}

fn described(program: &str) -> anyhow::Result<Tool> {
    let done = std::process::Command::new(program).arg("--describe-arguments").output()?;
    if !done.status.success() {
        bail!("{}", String::from_utf8_lossy(&done.stderr));
    }
    Ok(serde_json::from_slice(&done.stdout)?)
}

/// Writes the pages of a tool below a folder, as they lie below PREFIX/share.
fn pages(tool: &Tool, folder: &Path) -> anyhow::Result<()> {
    let mut page = Vec::new();
    clap_mangen::Man::new(command(tool)).manual("Grainpipe").render(&mut page)?;
    let man = folder.join("man/man1");
    fs::create_dir_all(&man)?;
    fs::write(man.join(format!("{}.1", tool.name)), page)?;
    for (shell, place) in SHELLS {
        let place = folder.join(place);
        fs::create_dir_all(&place)?;
        let file = generate_to(shell, &mut command(tool), &tool.name, &place)?;
        // bash looks for a file of the program's name alone.
        if shell == Shell::Bash {
            fs::rename(file, place.join(&tool.name))?;
        }
    }
    Ok(())
}

/// Text for as long as the program runs, as clap wants it.
fn kept(text: &str) -> &'static str {
    Box::leak(text.to_owned().into_boxed_str())
}

fn command(tool: &Tool) -> Command {
    let text = |text: &Option<String>| text.as_deref().map(kept);
    let mut command = Command::new(kept(&tool.name)).args(tool.arguments.iter().map(argument));
    if let Some(version) = text(&tool.version) {
        command = command.version(version);
    }
    if let Some(about) = text(&tool.about) {
        command = command.about(about);
    }
    if let Some(about) = text(&tool.long_about) {
        command = command.long_about(about);
    }
    match text(&tool.after_help) {
        Some(after) => command.after_help(after),
        None => command,
    }
}

fn argument(of: &Argument) -> Arg {
    let many = of.repeats && of.long.is_none();
    let mut arg = Arg::new(kept(&of.id)).required(of.required);
    if let Some(long) = &of.long {
        arg = arg.long(kept(long)).visible_aliases(of.aliases.iter().map(|alias| kept(alias)));
    }
    if let Some(short) = of.short {
        arg = arg.short(short);
    }
    if let Some(help) = &of.help {
        // Man pages leave out aliases.
        let aliases: String = of.aliases.iter().map(|alias| format!(" [alias: --{alias}]")).collect();
        arg = arg.help(kept(&format!("{help}{aliases}")));
    }
    if !of.takes_value {
        return arg.action(ArgAction::SetTrue);
    }
    arg = arg.action(if of.repeats { ArgAction::Append } else { ArgAction::Set });
    arg = arg.value_names(of.value_names.iter().map(|name| kept(name)));
    if many {
        arg = arg.num_args(0..);
    }
    if !of.values.is_empty() {
        let choice = |c: &Choice| match &c.help {
            Some(help) => PossibleValue::new(kept(&c.name)).help(kept(help)),
            None => PossibleValue::new(kept(&c.name)),
        };
        arg = arg.value_parser(of.values.iter().map(choice).collect::<Vec<_>>());
    }
    arg.default_values(of.defaults.iter().map(|value| kept(value)))
}

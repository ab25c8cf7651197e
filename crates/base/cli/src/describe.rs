//! The command line as data, from which pipelines/pages makes man pages and completions: the tools need not carry code for either.

use crate::clash;
use clap::{Arg, ArgAction, Command};
use serde_json::{Value, json};

/// The only argument that asks for it; it is not an option of the tool and not in `--help`.
pub const ASKED: &str = "--describe-arguments";

/// Whether the command line is [`ASKED`] alone.
pub fn is_asked() -> bool {
    let mut words = std::env::args_os().skip(1);
    words.next().is_some_and(|word| word == ASKED) && words.next().is_none()
}

/// The description, as JSON.
pub fn text(command: &Command) -> String {
    let words = |styled: Option<&clap::builder::StyledStr>| styled.map(ToString::to_string);
    let arguments: Vec<Value> = command.get_arguments().filter(|a| !a.is_hide_set()).map(argument).collect();
    json!({
        "name": command.get_name(),
        "version": command.get_version(),
        "about": words(command.get_about()),
        "long_about": words(command.get_long_about()),
        "after_help": words(command.get_after_long_help().or(command.get_after_help())),
        "arguments": arguments,
    })
    .to_string()
}

fn argument(argument: &Arg) -> Value {
    let takes_value = argument.get_action().takes_values();
    let values = if takes_value { argument.get_possible_values() } else { Vec::new() };
    let values = values.iter().filter(|value| !value.is_hide_set());
    let values =
        values.map(|v| json!({ "name": v.get_name(), "help": v.get_help().map(ToString::to_string) }));
    let names = argument.get_value_names().unwrap_or_default();
    json!({
        "id": argument.get_id().as_str(),
        "long": argument.get_long(),
        "aliases": argument.get_visible_aliases().unwrap_or_default(),
        "short": argument.get_short(),
        "help": argument.get_long_help().or(argument.get_help()).map(ToString::to_string),
        "takes_value": takes_value,
        "writes": clash::is_output(argument),
        "value_names": names.iter().map(ToString::to_string).collect::<Vec<_>>(),
        "values": values.collect::<Vec<_>>(),
        "defaults": default(argument),
        "required": argument.is_required_set(),
        "repeats": matches!(argument.get_action(), ArgAction::Append),
    })
}

/// The default, where help shows it.
fn default(argument: &Arg) -> Vec<String> {
    let shown = argument.get_action().takes_values() && !argument.is_hide_default_value_set();
    let values = argument.get_default_values().iter().filter(|_| shown);
    values.map(|value| value.to_string_lossy().into_owned()).collect()
}

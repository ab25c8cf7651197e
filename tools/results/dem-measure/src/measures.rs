//! The measure that is asked for: an option for each one of the registry.

use crate::args::{shape, side};
use clap::error::ErrorKind;
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Command, FromArgMatches, value_parser};
use geom::{Plane, Vec3};
use measure::definition::{Argument, ArgumentKind, GivenShape};
use measure::registry::{ALL, Entry};

/// The group that the options of all measures form.
pub const GROUP: &str = "measure";

/// The measure that is asked for.
#[derive(Debug)]
pub struct Chosen {
    /// Its line in the registry.
    pub entry: &'static Entry,
    /// What was given with its option.
    pub argument: Argument,
    /// Options of how to measure that were given, of this measure or of others.
    pub options: Vec<&'static str>,
}

impl clap::Args for Chosen {
    fn augment_args(command: Command) -> Command {
        command.args(ALL.iter().map(option))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Chosen::augment_args(command)
    }
}

impl FromArgMatches for Chosen {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Chosen, clap::Error> {
        let given = |id: &str| matches.value_source(id) == Some(ValueSource::CommandLine);
        let none = || clap::Error::new(ErrorKind::MissingRequiredArgument);
        let entry = ALL.iter().find(|entry| given(entry.name)).ok_or_else(none)?;
        let mut options = Vec::new();
        for name in ALL.iter().flat_map(|entry| entry.options).copied() {
            // Derived from fields.
            if given(&name.replace('-', "_")) && !options.contains(&name) {
                options.push(name);
            }
        }
        Ok(Chosen { entry, argument: argument(entry, matches).ok_or_else(none)?, options })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Chosen::from_arg_matches(matches)?;
        Ok(())
    }
}

fn option(entry: &'static Entry) -> Arg {
    let option = Arg::new(entry.name).long(entry.name).help(entry.help).group(GROUP);
    let option = match entry.argument.value_name() {
        Some(name) => option.value_name(name),
        None => option,
    };
    match entry.argument {
        ArgumentKind::None => option.action(ArgAction::SetTrue),
        ArgumentKind::Plane | ArgumentKind::Axis => {
            option.value_parser(value_parser!(Plane)).allow_hyphen_values(true)
        }
        ArgumentKind::Shape | ArgumentKind::Room => option.value_parser(shape),
        ArgumentKind::Ids => {
            option.value_parser(value_parser!(u64)).value_delimiter(',').action(ArgAction::Append)
        }
        ArgumentKind::Side => option.value_parser(side).allow_hyphen_values(true),
    }
}

fn argument(entry: &Entry, matches: &ArgMatches) -> Option<Argument> {
    let id = entry.name;
    match entry.argument {
        ArgumentKind::None => Some(Argument::None),
        ArgumentKind::Plane | ArgumentKind::Axis => {
            matches.get_one::<Plane>(id).copied().map(Argument::Plane)
        }
        ArgumentKind::Shape | ArgumentKind::Room => {
            matches.get_one::<GivenShape>(id).cloned().map(Argument::Shape)
        }
        ArgumentKind::Ids => Some(Argument::Ids(matches.get_many::<u64>(id)?.copied().collect())),
        ArgumentKind::Side => matches.get_one::<Vec3>(id).copied().map(Argument::Side),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::Args;
    use clap::CommandFactory;
    use std::collections::BTreeSet;

    /// `(default 8) [repose]; sectors of the rings (default 1) [radial: …]`: the names of measures in brackets.
    fn named(help: &str) -> BTreeSet<&'static str> {
        let parts = help.split('[').skip(1).filter_map(|part| Some(part.split_once(']')?.0));
        let words: Vec<&str> = parts.flat_map(|part| part.split([',', ';', ':', ' '])).collect();
        ALL.iter().map(|entry| entry.name).filter(|name| words.contains(name)).collect()
    }

    /// The help of an option names the measures that take it, and each option of a measure is there.
    #[test]
    fn the_help_of_an_option_names_the_measures_that_take_it() {
        let command = Args::command();
        for name in ALL.iter().flat_map(|entry| entry.options) {
            let option = command.get_arguments().find(|a| a.get_long() == Some(*name));
            let help = option.and_then(Arg::get_help).unwrap_or_else(|| panic!("--{name}")).to_string();
            let take = ALL.iter().filter(|entry| entry.options.contains(name)).map(|entry| entry.name);
            assert_eq!(named(&help), take.collect::<BTreeSet<_>>(), "--{name}: {help}");
        }
        let how = command.get_arguments().filter(|a| a.get_help_heading() == Some("How"));
        for option in how.filter_map(Arg::get_long) {
            assert!(ALL.iter().any(|entry| entry.options.contains(&option)), "no measure takes --{option}");
        }
    }
}

//! `man`: the manual pages, made from the same definitions that `--help` is made from.

use super::arguments::Arguments;
use super::{Ended, terminal};
use crate::files::diagnostic::quoted;
use clap::{Command, CommandFactory};
use clap_mangen::Man;

/// Runs the command.
pub fn run(command: Option<&str>) -> Ended {
    let mut program = Arguments::command();
    program.build();
    let page = match command {
        None => Some(program),
        // `build` has named the page of `synth` linkwright-synth.
        Some(name) => program.find_subcommand(name).cloned(),
    };
    let Some(page) = page else {
        let program = Arguments::command();
        let names: Vec<&str> = program.get_subcommands().map(Command::get_name).collect();
        let name = quoted(command.unwrap_or_default());
        terminal::complain(&format!("there is no command {name}: the commands are {}", names.join(", ")));
        return Ended::Refused;
    };
    let mut text = Vec::new();
    match Man::new(page).render(&mut text) {
        Ok(()) => {
            terminal::answer(&String::from_utf8_lossy(&text));
            Ended::Good
        }
        Err(e) => {
            terminal::complain(&format!("the manual page cannot be written: {e}"));
            Ended::Refused
        }
    }
}

//! `man`: the manual pages, made from the same definitions that `--help` is made from.

use super::arguments::Arguments;
use super::{Ended, refuse, terminal};
use crate::files::diagnostic::quoted;
use clap::{Command, CommandFactory};
use clap_mangen::Man;

/// Runs the command.
pub fn run(command: Option<&str>) -> Result<Ended, Ended> {
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
        return Err(refuse(format!("there is no command {name}: the commands are {}", names.join(", "))));
    };
    let mut text = Vec::new();
    let rendered = Man::new(page).render(&mut text);
    rendered.map_err(|e| refuse(format!("the manual page cannot be written: {e}")))?;
    terminal::answer(&String::from_utf8_lossy(&text));
    Ok(Ended::Good)
}

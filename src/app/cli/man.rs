//! `man`: the manual pages, made from the same definitions that `--help` is made from.

use super::arguments::Arguments;
use super::{Ended, refuse, terminal};
use crate::files::diagnostic::quoted;
use clap::CommandFactory;
use clap_mangen::Man;

/// Runs the command.
pub fn run(command: Option<&str>) -> Result<Ended, Ended> {
    let mut program = Arguments::command();
    let names: Vec<String> = program.get_subcommands().map(|command| command.get_name().to_owned()).collect();
    // The page of `synth` is named linkwright-synth by this.
    program.build();
    let page = match command {
        None => program,
        Some(name) => program.find_subcommand(name).cloned().ok_or_else(|| {
            refuse(format!("there is no command {}: the commands are {}", quoted(name), names.join(", ")))
        })?,
    };
    let mut text = Vec::new();
    let rendered = Man::new(page).render(&mut text);
    rendered.map_err(|e| refuse(format!("the manual page cannot be written: {e}")))?;
    terminal::answer(&String::from_utf8_lossy(&text));
    Ok(Ended::Good)
}

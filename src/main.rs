//! `linkwright`, the command.

use std::process::ExitCode;

fn main() -> ExitCode {
    linkwright::internals::app::cli::main()
}

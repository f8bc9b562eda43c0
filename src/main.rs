//! The command line.

use std::process::ExitCode;

use clap::Parser;
use midair::cli::{Cli, run};

fn main() -> ExitCode {
    // clap answers wrong usage itself, with status 2.
    match run(Cli::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // One line: the causes follow the message, each says why.
            eprintln!("midair: {error:#}");
            ExitCode::FAILURE
        }
    }
}

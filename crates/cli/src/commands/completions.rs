//! `kirkas completions`: what a shell needs to complete the command line.

use crate::output::print_out;
use crate::problem::{Outcome, Problem};
use clap::CommandFactory;

const EXAMPLES: &str = "Example:
  kirkas completions bash > ~/.local/share/bash-completion/completions/kirkas";

/// Print the completions of a shell
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Completions {
    /// Which shell
    shell: clap_complete::Shell,
}

/// Do it.
pub fn run(args: &Completions) -> Result<Outcome, Problem> {
    let mut text = Vec::new();
    clap_complete::generate(args.shell, &mut crate::Kirkas::command(), "kirkas", &mut text);
    print_out(&text)?;
    Ok(Outcome::Done)
}

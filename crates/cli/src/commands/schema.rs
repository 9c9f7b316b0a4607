//! `kirkas schema`: what a scene may say, for editors.

use crate::output::{check_writable, print_out, write_atomically};
use crate::problem::{Outcome, Problem};
use kirkas_formats::manual::markdown;
use kirkas_formats::schema::json_schema;
use kirkas_render::catalog;
use std::path::PathBuf;

const EXAMPLES: &str = "Example:
  kirkas schema -o kirkas.schema.json
  (and in a scene's first line: `#:schema kirkas.schema.json`)";

/// Print the JSON Schema of native scenes, by which an editor completes and checks them
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Schema {
    /// File to write instead
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// The manual of all types and parameters instead, as Markdown
    #[arg(long, conflicts_with = "explanation")]
    manual: bool,
    /// The JSON Schema of what `kirkas explain -o FILE.json` writes instead
    #[arg(long)]
    explanation: bool,
}

/// Do it.
pub fn run(args: &Schema) -> Result<Outcome, Problem> {
    let mut text = match (args.manual, args.explanation) {
        (true, _) => markdown(&catalog()),
        (_, true) => format!("{:#}", kirkas_explain::schema()),
        _ => json_schema(&catalog()),
    };
    if !text.ends_with('\n') {
        text.push('\n');
    }
    match &args.output {
        Some(path) => {
            check_writable(path)?;
            write_atomically(path, text.as_bytes())?;
        }
        None => print_out(text.as_bytes())?,
    }
    Ok(Outcome::Done)
}

//! Why a command ends without doing what was asked, and the exit code that says so.

use kirkas_formats::Failure;
use kirkas_scene::{Diagnostic, Sources};

/// How a command ended that did what it could.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Done.
    Done,
    /// `check` found the scene wanting.
    BadInput,
    /// `diff` found more than `--max`.
    OverMax,
}

impl Outcome {
    /// The exit code of the contract.
    pub fn code(self) -> u8 {
        match self {
            Outcome::Done => 0,
            Outcome::BadInput => 2,
            Outcome::OverMax => 3,
        }
    }
}

/// Something that the user is told, and that ends the command.
#[derive(Debug)]
pub struct Problem {
    /// 1 failed, 2 bad usage or bad input.
    pub code: u8,
    /// The texts that the diagnostics point into; boxed, since it is seldom needed.
    pub failure: Box<Failure>,
}

impl Problem {
    /// Bad usage or bad input.
    pub fn input(diagnostic: Diagnostic) -> Self {
        Problem { code: 2, failure: Box::new(diagnostic.into()) }
    }

    /// The same, pointing into texts.
    pub fn in_sources(sources: &Sources, diagnostics: Vec<Diagnostic>) -> Self {
        Problem { code: 2, failure: Box::new(Failure::new(sources.clone(), diagnostics)) }
    }

    /// Good input, but the work failed.
    pub fn failed(diagnostic: Diagnostic) -> Self {
        Problem { code: 1, failure: Box::new(diagnostic.into()) }
    }
}

impl From<Failure> for Problem {
    fn from(failure: Failure) -> Self {
        Problem { code: 2, failure: Box::new(failure) }
    }
}

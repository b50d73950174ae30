//! Peers in programs of their own: a line of JSON in, a line of JSON out.

use std::io::{BufRead as _, BufReader, Write as _};
use std::process::{Child, ChildStdout, Command, Stdio};

use serde::de::DeserializeOwned;
use serde_json::Value;

/// A running program.
pub(crate) struct Service {
    child: Child,
    answers: BufReader<ChildStdout>,
}

impl Service {
    /// Starts a program and tells it the problem.
    pub(crate) fn start(command: &mut Command, problem: &Value) -> Result<Self, String> {
        let command = command.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command
            .spawn()
            .map_err(|error| format!("error: cannot run a peer: {error}"))?;
        let answers = child.stdout.take().ok_or("error: a peer has no output")?;
        let mut service = Self {
            child,
            answers: BufReader::new(answers),
        };
        service.write(problem)?;
        Ok(service)
    }

    /// The answer to a request.
    pub(crate) fn ask<A: DeserializeOwned>(&mut self, request: &Value) -> Result<A, String> {
        self.write(request)?;
        let mut line = String::new();
        let read = self.answers.read_line(&mut line);
        read.map_err(|error| format!("error: a peer does not answer: {error}"))?;
        let answer: Value = serde_json::from_str(&line)
            .map_err(|error| format!("error: a peer's answer to {request}: {error}"))?;
        match answer["failure"].as_str() {
            Some(failure) => Err(failure.to_owned()),
            None => serde_json::from_value(answer).map_err(|error| format!("error: {error}")),
        }
    }

    fn write(&mut self, line: &Value) -> Result<(), String> {
        let problem = |error| format!("error: a peer does not listen: {error}");
        let input = self
            .child
            .stdin
            .as_mut()
            .ok_or("error: a peer has no input")?;
        writeln!(input, "{line}").map_err(problem)
    }
}

impl Drop for Service {
    /// The program ends with its input.
    fn drop(&mut self) {
        drop(self.child.stdin.take());
        let _ = self.child.wait();
    }
}

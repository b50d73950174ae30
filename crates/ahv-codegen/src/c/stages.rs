//! What functions share, as C: functions that fill structs, and their calls.

use super::functions::{Argument, Functions, Text, trimmed};
use super::print::Printer;
use crate::graph::Kind;
use crate::schedule::given::Stage;
use crate::schedule::stages;
use crate::schedule::tree::Source;
use crate::wording::wrapped;

impl Functions<'_> {
    /// A stage: its parts, and the function that fills it.
    pub(super) fn stage(&self, stage: &Stage) -> Vec<Text> {
        let kind = stage.kind;
        let own = (
            format!("{}{} *", self.types.own, kind.type_name),
            kind.argument.to_owned(),
        );
        let is_prepared = *kind == stages::PREPARED;
        let parameters = (
            format!("const {}Parameters *", self.types.table),
            "p".to_owned(),
        );
        let arguments = |uses: &dyn Fn(Source) -> bool| {
            if is_prepared {
                vec![parameters.clone()]
            } else {
                self.taken(uses, Some(kind))
            }
        };
        let printer = Printer {
            holds_stages: false,
        };
        let (mut texts, mut calls) = (Vec::new(), Vec::new());
        let is_whole = stage.parts.len() == 1;
        for (number, part) in (1..).zip(&stage.parts) {
            let lines = part.statements.iter().flat_map(|it| printer.statement(it));
            if is_whole {
                calls.extend(lines);
                continue;
            }
            let name = format!("{}_part_{number}", kind.function);
            let mut taken = arguments(&|source| part.uses(source));
            let names: Vec<String> = taken.iter().map(|(_, name)| name.clone()).collect();
            let names = [names, vec![kind.argument.to_owned()]].concat().join(", ");
            calls.push(format!("    {}{name}({names});", self.prefix));
            taken.push(own.clone());
            let docs = [format!(
                "Computes a part of {}.",
                own.0.trim_end_matches(" *")
            )];
            texts.push(Text {
                is_static: true,
                lines: trimmed(lines.collect()),
                ..self.text(&name, "void", &taken, &docs)
            });
        }
        let mut taken = if is_prepared {
            vec![parameters.clone()]
        } else {
            let model = [Kind::State, Kind::Input, Kind::Parameter];
            let mut taken: Vec<Argument> = model.map(|it| self.model_argument(it)).into();
            let stages = self.program.stages.iter().map(|it| it.kind);
            let stages = stages.filter(|it| *it != kind && stage.uses(Source::Stage(it)));
            taken.extend(stages.map(|it| self.stage_argument(it)));
            taken
        };
        let unused = |name: &str| match name {
            "x" => !stage.uses(Source::Argument(Kind::State)),
            "u" => !stage.uses(Source::Argument(Kind::Input)),
            "p" => !stage.uses(Source::Argument(Kind::Parameter)),
            _ => false,
        };
        let unused = taken.iter().filter(|(_, name)| unused(name));
        let mut lines: Vec<String> = unused
            .map(|(_, name)| format!("    (void){name};"))
            .collect();
        lines.extend(calls);
        taken.push(own);
        let docs = if is_prepared {
            "Computes what depends on parameters alone. Call it once, and again when a parameter changes.".to_owned()
        } else {
            format!("Computes the {}.", lower(kind.doc))
        };
        texts.push(Text {
            lines: trimmed(lines),
            ..self.text(kind.function, "void", &taken, &wrapped(&docs))
        });
        texts
    }

    /// The lines that declare and compute the stages of a function.
    pub(super) fn stages(&self, positions: &[usize]) -> Vec<String> {
        let mut lines = Vec::new();
        for &position in positions {
            let kind = self.program.stages[position].kind;
            let of = format!("{}{}", self.types.own, kind.type_name);
            lines.push(format!("    {of} {};", kind.argument));
        }
        for &position in positions {
            let stage = &self.program.stages[position];
            let earlier = self.program.earlier(position).into_iter();
            let earlier: String = earlier
                .map(|kind| format!("&{}, ", kind.argument))
                .collect();
            let (name, argument) = (stage.kind.function, stage.kind.argument);
            lines.push(format!(
                "    {}{name}(x, u, p, {earlier}&{argument});",
                self.prefix
            ));
        }
        lines
    }
}

fn lower(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_lowercase().chain(letters).collect()
    })
}

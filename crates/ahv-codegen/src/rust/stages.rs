//! What functions share, as Rust: structs, and the functions that fill them.

use askama::Template;

use super::items;
use super::print::statement;
use super::records::{self, Copied, Field};
use super::wording::arguments;
use crate::graph::Kind;

use crate::schedule::given::Stage;
use crate::schedule::pieces::sliced;
use crate::schedule::program::{Program, taken};
use crate::schedule::stages;
use crate::schedule::tree::{Body, Expr, Source, StageKind, Statement};
use crate::template::render;
use crate::wording::wrapped;
use crate::{EmitError, ir};

/// How what is said of a derivative begins; its name says it too.
const DERIVATIVE: &str = "Derivative of ";

#[derive(Template)]
#[template(path = "stages.rs")]
struct StagesTemplate {
    about: String,
    imports: Vec<&'static str>,
    stages: Vec<StageText>,
}

struct StageText {
    kind: &'static StageKind,
    docs: Vec<String>,
    record: String,
    /// Its first value: nothing is filled in yet.
    start: &'static str,
    arguments: String,
    /// Whether it is a part of every function that calls it.
    is_inline: bool,
    /// Statements, where one part fills all.
    statements: Vec<String>,
    /// Otherwise what each part takes, its call and its statements.
    parts: Vec<PartText>,
}

struct PartText {
    name: String,
    arguments: String,
    call: String,
    statements: Vec<String>,
}

/// The file of what is prepared from the parameters.
pub(super) fn prepared(program: &Program<'_>) -> Result<String, EmitError> {
    let stage = &program.prepared;
    let text = StageText {
        docs: vec!["Computes everything that depends on parameters alone.".to_owned()],
        ..stage_text(stage, &[], "Parameters", program.document)
    };
    render(&StagesTemplate {
        about: format!(
            "What {} computes from its parameters once.",
            program.label()
        ),
        imports: vec!["Parameters"],
        stages: vec![text],
    })
}

/// What functions share.
pub(super) fn shared(program: &Program<'_>) -> Result<String, EmitError> {
    let stages = program.stages.iter();
    let stages =
        stages.map(|stage| stage_text(stage, &program.stages, "Prepared", program.document));
    render(&StagesTemplate {
        about: format!(
            "What functions of {} share. Units are {}.",
            program.label(),
            program.document.units.in_words()
        ),
        imports: vec!["Input", "Prepared", "State"],
        stages: stages.collect(),
    })
}

/// The statements that fill a stage, part by part, and the parameters that it takes over as they are.
fn filling<'a>(stage: &'a Stage, document: &'a ir::Document) -> (Vec<Body>, Copied<'a>) {
    let mut copied = Copied {
        of: "Parameters",
        groups: Vec::new(),
    };
    if *stage.kind != stages::PREPARED {
        return (stage.parts.clone(), copied);
    }
    let (mut statements, mut heading) = (Vec::new(), None);
    let mut section = None;
    for statement in stage.parts.iter().flat_map(|part| &part.statements) {
        match statement {
            Statement::Set {
                field,
                value: Expr::Component(Source::Argument(Kind::Parameter), name),
                ..
            } if field == name => {
                let parameter = document.parameters.iter().find(|it| it.name == *name);
                let of = parameter.map(|it| &it.path.0);
                match copied.groups.last_mut().filter(|_| of == section) {
                    Some(group) => group.push(field),
                    None => copied.groups.push(vec![field]),
                }
                section = of;
            }
            // A part that goes on with a section has its heading again.
            Statement::Section(text) if heading == Some(text) => {}
            Statement::Section(text) => {
                heading = Some(text);
                statements.push(statement.clone());
            }
            other => statements.push(other.clone()),
        }
    }
    (sliced(statements), copied)
}

/// A stage; `p` are values of this type.
fn stage_text(
    stage: &Stage,
    all: &[Stage],
    parameters: &str,
    document: &ir::Document,
) -> StageText {
    let kind = stage.kind;
    let (filling, copied) = filling(stage, document);
    let is_own = |name: &str| !copied.groups.iter().flatten().any(|it| *it == name);
    let fields = stage.fields.iter().filter(|field| is_own(&field.name));
    let fields = fields.map(|field| Field {
        name: &field.name,
        about: field.about.clone().filter(|it| !it.starts_with(DERIVATIVE)),
    });
    let about = format!(
        "{}. A field without a description is what its name says: its formula and unit stand in [`{}`].",
        kind.doc, kind.function
    );
    let fields: Vec<Field<'_>> = fields.collect();
    let record = records::record(&wrapped(&about), kind.type_name, &fields, &copied);
    let arguments = if parameters == "Parameters" {
        format!("p: &{parameters}<R>")
    } else {
        let mut arguments = arguments(|kind| stage.uses(Source::Argument(kind)));
        let earlier = all.iter().map(|it| it.kind).filter(|it| **it != *kind);
        let earlier = earlier.filter(|kind| stage.uses(Source::Stage(kind)));
        arguments.extend(earlier.map(|kind| items::stage_argument(kind, true)));
        arguments.join(", ")
    };
    let is_whole = filling.len() == 1;
    let mut statements = filling.iter();
    let mut statements: Vec<Vec<String>> = statements
        .by_ref()
        .map(|part| part.statements.iter().map(statement).collect())
        .collect();
    let whole = if is_whole {
        statements.remove(0)
    } else {
        Vec::new()
    };
    let parts = filling.iter().zip(statements).zip(1..);
    let parts = parts.map(|((part, statements), number)| {
        let taken = items::named(&taken(|source| part.uses(source), all)).into_iter();
        let taken: Vec<_> = taken.filter(|(name, _)| *name != kind.argument).collect();
        let name = format!("{}_part_{number}", kind.function);
        let types = taken.iter().map(|(name, of)| {
            let of = if *name == "p" { parameters } else { of };
            format!("{name}: &{of}<R>")
        });
        let own = format!("{}: &mut {}<R>", kind.argument, kind.type_name);
        let names = taken.iter().map(|(name, _)| (*name).to_owned());
        let names: Vec<String> = [format!("&mut {}", kind.argument)]
            .into_iter()
            .chain(names)
            .collect();
        PartText {
            call: format!("{name}({});", names.join(", ")),
            arguments: [own]
                .into_iter()
                .chain(types)
                .collect::<Vec<_>>()
                .join(", "),
            name,
            statements,
        }
    });
    StageText {
        kind,
        docs: vec![format!("Computes [`{}`].", kind.type_name)],
        record,
        start: if copied.groups.is_empty() {
            "splat(R::ZERO)"
        } else {
            "copied(p)"
        },
        arguments,
        is_inline: *kind != stages::PREPARED,
        parts: if is_whole {
            Vec::new()
        } else {
            parts.collect()
        },
        statements: whole,
    }
}

//! From tables and IR to the files of the generated package.

use askama::Template;
use std::collections::{BTreeMap, BTreeSet};

use crate::c;
use crate::docs::{self, Page};
use crate::graph::passes::Passes;
use crate::ir::{Document, Model, SCHEMA_VERSION, UnitSystem};
use crate::manifest::{Earlier, Manifest, sha256};
use crate::parallel;
use crate::rust::{self, format::format_rust};
use crate::schedule::effect;
use crate::schedule::program::Program;
use crate::subject::Subject;
use crate::template::render;
use crate::values::Values;
use crate::wording::visible;
use crate::{EmitError, Table, Tree};

/// The command that makes and mends the generated files.
const COMMAND: &str = "ahv generate";
/// Under this name stands, beside the IRs of the tables, the audit of the printed equations.
pub const AUDIT: &str = "audit";
const AUDIT_PAGE: &str = "docs/audit.md";

/// The templates of the Rust package, for the manifest; those of its documentation stand in `docs`.
const RUST_TEMPLATES: [&str; 11] = [
    include_str!("../templates/manifest.toml"),
    include_str!("../templates/choices.rs"),
    include_str!("../templates/description.rs"),
    include_str!("../templates/functions.rs"),
    include_str!("../templates/lib.rs"),
    include_str!("../templates/model.rs"),
    include_str!("../templates/nominal.rs"),
    include_str!("../templates/parameters.rs"),
    include_str!("../templates/provenance.rs"),
    include_str!("../templates/stages.rs"),
    include_str!("../templates/table.rs"),
];

/// What the generated package is called and where it finds `ahv-core`.
#[derive(Clone, Debug)]
pub struct Options {
    /// Name of the package.
    pub package: String,
    /// Where `ahv-core` comes from.
    pub core: Core,
    /// Unit system; without one that of the table.
    pub units: Option<UnitSystem>,
    /// The rules by which expressions are rewritten.
    pub passes: Passes,
    /// The language.
    pub target: Target,
}

/// A language that models are emitted in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Target {
    /// A crate, with documentation.
    #[default]
    Rust,
    /// A C99 library.
    C,
}

impl Target {
    /// What the manifest calls the language; it names none for Rust.
    #[must_use]
    pub fn language(self) -> Option<&'static str> {
        match self {
            Self::Rust => None,
            Self::C => Some("c"),
        }
    }
}

/// Where the generated package finds `ahv-core`.
#[derive(Clone, Debug)]
pub enum Core {
    /// At a path relative to the package.
    Path(String),
    /// Where the workspace around the package says.
    Workspace,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            package: "ahv-models".to_owned(),
            core: Core::Path("../crates/ahv-core".to_owned()),
            units: None,
            passes: Passes::default(),
            target: Target::default(),
        }
    }
}

impl Options {
    /// The line of the package's manifest that names `ahv-core`.
    fn core_dependency(&self) -> String {
        match &self.core {
            Core::Path(path) => {
                let version = env!("CARGO_PKG_VERSION");
                // A TOML string of its own: a path may hold quotes and backslashes.
                let path = toml_edit::Value::from(path.as_str());
                format!(
                    "ahv-core = {{ version = \"{version}\", path = {} }}",
                    path.to_string().trim()
                )
            }
            Core::Workspace => "ahv-core.workspace = true".to_owned(),
        }
    }
}

#[derive(Template)]
#[template(path = "manifest.toml", escape = "none")]
struct CargoTemplate<'a> {
    options: &'a Options,
    /// As TOML has it, with its quotes.
    about: String,
    version: &'a str,
}

#[derive(Template)]
#[template(path = "lib.rs")]
struct LibTemplate<'a> {
    about: &'a str,
    modules: &'a [Module],
    units: &'static str,
}

struct Module {
    name: String,
    doc: String,
}

/// What is known of tables and tree when a package is emitted again.
#[derive(Debug, Default)]
pub struct Known {
    /// Hash of what derived the IRs, for the manifest.
    pub generator: String,
    /// Hash of the structure of each table, for the manifest.
    pub structure: BTreeMap<String, String>,
    /// The tree of an earlier emission.
    pub earlier: Option<Earlier>,
}

/// The files of the generated package, by their path in it.
///
/// `irs` holds the IR text of each table, by the table's name.
///
/// # Errors
/// [`EmitError`] when an IR cannot be read or does not belong to its table, or two tables make the same model.
pub fn emit(
    tables: &[Table],
    irs: &BTreeMap<String, String>,
    options: &Options,
) -> Result<Tree, EmitError> {
    emit_again(tables, irs, options, &Known::default())
}

/// The same tree as that of [`emit()`], with the manifest of what is `known`. Files of an earlier tree whose inputs have not
/// changed are taken from there: a changed value leaves the models' functions as they are.
///
/// # Errors
/// As for [`emit()`].
pub fn emit_again(
    tables: &[Table],
    irs: &BTreeMap<String, String>,
    options: &Options,
    known: &Known,
) -> Result<Tree, EmitError> {
    let mut tree = Tree::new();
    let mut read = Vec::new();
    for table in tables {
        let text = irs.get(&table.name).ok_or_else(|| {
            EmitError::Mismatch(format!("there is no IR for table `{}`", table.name))
        })?;
        let mut document = Document::parse(&table.name, text)?;
        let values = Values::read(table, &mut document, options.units)?;
        tree.insert(format!("ir/{}.json", table.name), text.clone());
        read.push((table, document, values));
    }
    let modules = modules(read.iter().map(|(table, document, _)| (*table, document)))?;
    for (table, document, _) in &read {
        check_choices(table, document)?;
    }
    let units: BTreeSet<_> = read.iter().map(|(_, d, _)| d.units.in_words()).collect();
    if units.len() > 1 {
        return Err(EmitError::Mismatch(
            "the tables are in different unit systems; choose one with --units".to_owned(),
        ));
    }
    let mut manifest = manifest(tables, irs, options, known);
    let system = read.first().map(|(_, document, _)| document.units.system);
    manifest.units = system.map_or_else(String::new, |it| it.name().to_owned());
    let earlier = known
        .earlier
        .as_ref()
        .filter(|it| it.has_emitter_of(&manifest));
    let subjects: Vec<Subject<'_>> = read
        .iter()
        .map(|(table, document, values)| Subject {
            table,
            document,
            values,
        })
        .collect();
    let units = units.first().copied().unwrap_or_default();
    match options.target {
        Target::Rust => {
            let package = Package {
                subjects: &subjects,
                irs,
                modules: &modules,
                units,
                options,
                earlier,
                manifest: &manifest,
            };
            package.emit(&mut tree)?;
        }
        Target::C => tree.extend(c::files(&subjects, units, &options.passes)?),
    }
    // The IRs are listed already.
    let files = tree
        .iter()
        .filter(|(path, _)| manifest.written(path).is_none());
    manifest.files = files
        .map(|(path, text)| (path.clone(), sha256(text)))
        .collect();
    tree.insert("manifest.json".to_owned(), manifest.sealed().render());
    Ok(tree)
}

/// The Rust package.
struct Package<'a> {
    subjects: &'a [Subject<'a>],
    irs: &'a BTreeMap<String, String>,
    modules: &'a [Module],
    units: &'static str,
    options: &'a Options,
    /// The tree of an earlier emission by the same emitter.
    earlier: Option<&'a Earlier>,
    manifest: &'a Manifest,
}

impl Package<'_> {
    fn emit(&self, tree: &mut Tree) -> Result<(), EmitError> {
        let Self {
            subjects,
            irs,
            modules,
            units,
            options,
            earlier,
            manifest,
        } = *self;
        let mut sources = Vec::new();
        let mut jobs = Vec::new();
        for subject in subjects {
            if let Some(files) = earlier.and_then(|it| all_of(subject, it, manifest)) {
                tree.extend(files);
                continue;
            }
            let home = emit_home(subject, &mut sources)?;
            tree.extend(docs::emit_table(subject)?);
            jobs.extend(subject.document.models.iter().map(|model| Job {
                subject: *subject,
                model,
                home,
                earlier: earlier.filter(|it| it.has_ir_of(manifest, &subject.table.name)),
            }));
        }
        tree.extend(emit_passes(subjects, earlier, manifest)?);
        for emitted in parallel::map(&jobs, |job| job.emit(&options.passes)) {
            let emitted = emitted?;
            sources.extend(emitted.sources);
            tree.extend(emitted.pages);
        }
        tree.extend(emit_audit(irs)?);
        let audit = tree.contains_key(AUDIT_PAGE).then(audit_page);
        let further: Vec<Page> = audit.into_iter().chain([docs::passes_page()]).collect();
        tree.extend(docs::emit_index(subjects, &further)?);
        let about = about(subjects);
        let lib = render(&LibTemplate {
            about: &about,
            modules,
            units,
        })?;
        sources.push(Source {
            path: "src/lib.rs".to_owned(),
            origin: "the tables",
            text: lib,
            known: None,
        });
        for formatted in parallel::map(&sources, Source::formatted) {
            let (path, text) = formatted?;
            tree.insert(path, text);
        }
        let cargo = CargoTemplate {
            options,
            about: toml_edit::Value::from(about).to_string(),
            version: env!("CARGO_PKG_VERSION"),
        };
        let cargo = render(&cargo)? + "\n";
        check_package(&options.package, &cargo)?;
        for subject in subjects {
            check_sets(subject, tree)?;
        }
        tree.insert("Cargo.toml".to_owned(), cargo);
        Ok(())
    }
}

/// What the package is, in a sentence.
fn about(subjects: &[Subject<'_>]) -> String {
    let names: Vec<_> = subjects.iter().map(|it| visible(&it.table.name)).collect();
    match names.as_slice() {
        [first @ .., second, last] => {
            let first: String = first.iter().map(|name| format!("{name}, ")).collect();
            format!("Models generated from the tables {first}{second} and {last}")
        }
        _ => format!("Models generated from the table {}", names.concat()),
    }
}

/// The modules of the package, one a model.
fn modules<'a>(
    documents: impl Iterator<Item = (&'a Table, &'a Document)>,
) -> Result<Vec<Module>, EmitError> {
    let (mut modules, mut taken) = (Vec::new(), BTreeMap::new());
    for (table, document) in documents {
        for model in &document.models {
            if let Some(other) = taken.insert(model.name.clone(), table.file_name.clone()) {
                return Err(EmitError::Mismatch(format!(
                    "both {other} and {} make the model `{}`; generate them into packages of their own",
                    table.file_name, model.name
                )));
            }
            modules.push(Module {
                name: model.name.clone(),
                doc: format!("{}.", model.heading()),
            });
        }
    }
    Ok(modules)
}

/// The audit of printed equations, where the derivation made one.
fn emit_audit(irs: &BTreeMap<String, String>) -> Result<Tree, EmitError> {
    let Some(text) = irs.get(AUDIT) else {
        return Ok(Tree::new());
    };
    Ok(Tree::from([
        (format!("ir/{AUDIT}.json"), text.clone()),
        (AUDIT_PAGE.to_owned(), docs::audit(text)?),
    ]))
}

fn audit_page() -> Page {
    Page {
        path: "audit.md".to_owned(),
        title: "Audit".to_owned(),
        about: "the paper's printed equations beside the derived ones, with their differences"
            .to_owned(),
    }
}

/// A Rust file before it is formatted.
struct Source<'a> {
    path: String,
    /// What it is made from.
    origin: &'a str,
    text: String,
    /// What became of the same text before.
    known: Option<&'a str>,
}

impl Source<'_> {
    fn formatted(&self) -> Result<(String, String), EmitError> {
        if let Some(text) = self.known {
            return Ok((self.path.clone(), text.to_owned()));
        }
        let header = format!(
            "Generated by `{COMMAND}` from {}. Do not edit.",
            visible(self.origin)
        );
        let text = format_rust(&self.path, &header, &self.text)?;
        Ok((self.path.clone(), text))
    }
}

/// The sources of a table's parameters; the module in which they stand.
fn emit_home<'a>(
    subject: &Subject<'a>,
    sources: &mut Vec<Source<'a>>,
) -> Result<&'a str, EmitError> {
    let Subject {
        table,
        document,
        values,
    } = *subject;
    let Some(home) = document.models.first() else {
        return Err(EmitError::Mismatch(format!(
            "the IR of table `{}` holds no model",
            table.name
        )));
    };
    for (file, text) in rust::home::files(document, values)? {
        sources.push(Source {
            path: format!("src/{}/{file}.rs", home.name),
            origin: &table.file_name,
            text,
            known: None,
        });
    }
    Ok(&home.name)
}

/// A model to emit.
struct Job<'a> {
    subject: Subject<'a>,
    model: &'a Model,
    home: &'a str,
    /// The tree of an earlier emission with the same IR.
    earlier: Option<&'a Earlier>,
}

/// What a model gives.
struct Emitted<'a> {
    sources: Vec<Source<'a>>,
    pages: Tree,
}

impl<'a> Job<'a> {
    fn emit(&self, passes: &Passes) -> Result<Emitted<'a>, EmitError> {
        self.model.check_names()?;
        let program = Program::new(self.model, self.home, self.subject.document, passes)?;
        let files = rust::files(&program)?.into_iter();
        let source = |(file, text): (String, String)| {
            let path = format!("src/{}/{file}.rs", self.model.name);
            Source {
                known: self.earlier.and_then(|it| it.text(&path)),
                path,
                origin: &self.subject.table.file_name,
                text,
            }
        };
        Ok(Emitted {
            sources: files.map(source).collect(),
            pages: docs::emit_model(&self.subject, self.model, &program.costs())?,
        })
    }
}

/// All files of a table and its models, where neither IR nor values have changed.
fn all_of(subject: &Subject<'_>, earlier: &Earlier, now: &Manifest) -> Option<Tree> {
    let (table, models) = (&subject.table.name, &subject.document.models);
    if !earlier.has_table_of(now, table) {
        return None;
    }
    let page = format!("docs/{table}-table.md");
    let of_model = |name: &str, path: &str| {
        let path = path
            .strip_prefix("src/")
            .or_else(|| path.strip_prefix("docs/images/"));
        path.and_then(|it| it.strip_prefix(name))
            .is_some_and(|it| it.starts_with(['/', '-']))
    };
    earlier.all(|path| {
        let mut names = models.iter().map(|model| model.name.as_str());
        path == page || names.any(|name| path == format!("docs/{name}.md") || of_model(name, path))
    })
}

/// The page of the passes, which depends on the models alone.
fn emit_passes(
    subjects: &[Subject<'_>],
    earlier: Option<&Earlier>,
    now: &Manifest,
) -> Result<Tree, EmitError> {
    let page = format!("docs/{}", docs::passes_page().path);
    if let Some(earlier) = earlier
        && earlier.manifest.tables.keys().eq(now.tables.keys())
        && now.tables.keys().all(|table| earlier.has_ir_of(now, table))
        && let Some(text) = earlier.text(&page)
    {
        return Ok(Tree::from([(page, text.to_owned())]));
    }
    let models: Vec<&Model> = subjects.iter().flat_map(|it| &it.document.models).collect();
    let effects = parallel::map(&models, |model| effect::of(model));
    let effects = effects.into_iter().collect::<Result<Vec<_>, EmitError>>()?;
    docs::emit_passes(models.into_iter().zip(&effects))
}

/// Types that stand beside those of choices.
const TYPES: [&str; 24] = [
    "Bounds",
    "Curvatures",
    "Diffusion",
    "Hessian",
    "Input",
    "InputJacobian",
    "Intermediates",
    "Model",
    "Noise",
    "NoiseClass",
    "NoiseDerivatives",
    "NoiseMatrix",
    "NoiseSlopes",
    "NoiseTerms",
    "Outputs",
    "ParameterJacobian",
    "Parameters",
    "Pattern",
    "Prepared",
    "Real",
    "Sensitivities",
    "Slopes",
    "State",
    "Validity",
];

/// The type of a choice must have a name of its own.
fn check_choices(table: &Table, document: &Document) -> Result<(), EmitError> {
    let mut choices = document.choices.iter();
    let taken = |name: &str| TYPES.contains(&name) || name == "StateJacobian" || name == "Vector";
    match choices.find(|choice| taken(&choice.type_name)) {
        Some(choice) => Err(EmitError::Mismatch(format!(
            "the type `{}` of the choice `{}` of {} has the name of a type that every model has; choose another name",
            choice.type_name, choice.name, table.file_name
        ))),
        None => Ok(()),
    }
}

/// Crates that every Rust program has.
const OWN_CRATES: [&str; 5] = ["alloc", "core", "proc_macro", "std", "test"];

/// The package's name must be one for a crate, and none of those that its manifest takes in.
fn check_package(package: &str, cargo: &str) -> Result<(), EmitError> {
    let in_code = |name: &str| name.replace('-', "_");
    let name = in_code(package);
    let refused = |why: &str| {
        let message =
            format!("the package cannot be called `{package}`: {why}; choose another name");
        Err(EmitError::Mismatch(message))
    };
    if syn::parse_str::<syn::Ident>(&name).is_err() {
        return refused("Rust has a word of its own like that");
    }
    let document = cargo.parse::<toml_edit::DocumentMut>();
    let document = document.map_err(|error| EmitError::Manifest(error.to_string()))?;
    let dependencies = document
        .get("dependencies")
        .and_then(|it| it.as_table_like());
    let mut dependencies = dependencies.into_iter().flat_map(|it| it.iter());
    if dependencies.any(|(dependency, _)| in_code(dependency) == name) {
        return refused("it needs a package of that name itself");
    }
    if OWN_CRATES.contains(&name.as_str()) {
        return refused("Rust has a crate of that name");
    }
    Ok(())
}

/// A set is a constant beside those that the models have anyway, whichever they are: all are in the tree by now.
fn check_sets(subject: &Subject<'_>, tree: &Tree) -> Result<(), EmitError> {
    let models = &subject.document.models;
    let own = |path: &str| {
        let mut modules = models.iter().map(|model| format!("src/{}/", model.name));
        modules.any(|module| path.starts_with(&module))
    };
    for set in subject.document.sets.iter().skip(1) {
        for constant in rust::home::constants(&set.name) {
            let constants = [
                format!("\npub const {constant}:"),
                format!(", {constant}: "),
            ];
            let files = tree.iter().filter(|(path, _)| own(path));
            let defines = |text: &str| constants.iter().any(|it| text.contains(it));
            if files.filter(|(_, text)| defines(text)).count() > 1 {
                return Err(EmitError::Mismatch(format!(
                    "the set `{}` of {} would become the constant {constant}, which the models have already; choose another \
                     name",
                    set.name, subject.table.file_name
                )));
            }
        }
    }
    Ok(())
}

/// The manifest without the hashes of files.
fn manifest(
    tables: &[Table],
    irs: &BTreeMap<String, String>,
    options: &Options,
    known: &Known,
) -> Manifest {
    let templates = match options.target {
        Target::Rust => RUST_TEMPLATES.concat() + &docs::TEMPLATES.concat(),
        Target::C => c::TEMPLATES.concat() + &c::LIBRARY.map(|(_, text)| text).concat(),
    };
    // The audit of printed equations is no part of a C library.
    let has = |name: &str| name != AUDIT || options.target == Target::Rust;
    let left_out = options.passes.left_out();
    Manifest {
        schema_version: SCHEMA_VERSION,
        emitter: env!("CARGO_PKG_VERSION").to_owned(),
        emitter_sources: include_str!(concat!(env!("OUT_DIR"), "/emitter.txt")).to_owned(),
        generator: known.generator.clone(),
        units: String::new(),
        structure: known.structure.clone(),
        tables: tables
            .iter()
            .map(|t| (t.name.clone(), t.sha256()))
            .collect(),
        ir: irs
            .iter()
            .filter(|(name, _)| has(name))
            .map(|(name, text)| (name.clone(), sha256(text)))
            .collect(),
        templates: sha256(&templates),
        language: options.target.language().map(str::to_owned),
        without_passes: left_out.map(|p| p.name().to_owned()).collect(),
        files: BTreeMap::new(),
        seal: String::new(),
    }
}

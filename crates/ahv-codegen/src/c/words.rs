//! Words that no name of a table may be, for C or C++ has them.

use super::types::{Struct, camel};
use crate::EmitError;
use crate::ir::Basis;
use crate::schedule::program::Program;
use crate::schedule::tree::{Expr, Statement};
use crate::subject::Subject;

/// Words of C99 and of C++ up to C++20, and macros of GNU.
const RESERVED: &str = "\
alignas alignof and and_eq asm auto bitand bitor bool break case catch char char8_t char16_t char32_t class compl concept \
const consteval constexpr constinit const_cast continue co_await co_return co_yield decltype default delete do double \
dynamic_cast else enum explicit export extern false float for friend goto if inline int long mutable namespace new noexcept \
not not_eq nullptr operator or or_eq private protected public register reinterpret_cast requires restrict return short \
signed sizeof static static_assert static_cast struct switch template this thread_local throw true try typedef typeid \
typename union unsigned using virtual void volatile wchar_t while xor xor_eq linux unix";

/// Refuses a name that is a word of the language.
pub(super) fn check(program: &Program<'_>, structs: &[Struct]) -> Result<(), EmitError> {
    let fields = structs.iter().flat_map(|it| &it.fields);
    let fields = fields.map(|(_, name, _)| name.as_str());
    let parameters = program.document.parameters.iter().map(|it| &*it.name);
    let arguments = program.model.bases.get(&Basis::Argument);
    let arguments = arguments.into_iter().flatten().map(|it| &*it.name);
    let stages = [&program.prepared].into_iter().chain(&program.stages);
    let bodies = stages.flat_map(|it| &it.parts);
    let bodies = bodies.chain(program.functions.iter().flat_map(|it| {
        let pieces = it.pieces.iter().map(|(_, body)| body);
        pieces.chain([&it.body])
    }));
    let statements = bodies.flat_map(|it| &it.statements);
    let named = statements.filter_map(|it| match it {
        Statement::Let { name, .. } => Some(name.as_str()),
        Statement::SinCos {
            sin: Expr::Name(name),
            ..
        } => Some(name.as_str()),
        _ => None,
    });
    let mut names = fields.chain(parameters).chain(arguments).chain(named);
    let reserved = |name: &&str| RESERVED.split(' ').any(|word| word == *name);
    match names.find(reserved) {
        Some(name) => Err(EmitError::Mismatch(format!(
            "`{name}` of model `{}` is a word of C or C++; choose another name, or generate Rust (--target rust)",
            program.model.name
        ))),
        None => Ok(()),
    }
}

/// Refuses models and tables whose types would begin alike: `vdp1` and `vdp_1`.
pub(super) fn check_types(subjects: &[Subject<'_>]) -> Result<(), EmitError> {
    let models = subjects.iter().flat_map(|it| &it.document.models);
    let names: Vec<&str> = models.map(|it| &*it.name).collect();
    for (position, name) in names.iter().enumerate() {
        let mut others = names[..position].iter();
        if let Some(other) = others.find(|other| camel(other) == camel(name)) {
            return Err(EmitError::Mismatch(format!(
                "the C types of the models `{other}` and `{name}` would have the same names; choose another name for one"
            )));
        }
    }
    Ok(())
}

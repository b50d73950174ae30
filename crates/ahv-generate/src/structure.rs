//! What an IR depends on, as hashes: the structure of a table, which is all but its values, and the generator.

use ahv_codegen::ir::SCHEMA_VERSION;
use ahv_codegen::sha256;
use ahv_table::{Text, Unreadable};
use toml_edit::{Item, TableLike, Value};

use crate::python;

/// Sections whose numbers are no values of parameters.
const PLAIN: [&str; 7] = [
    "table", "sources", "choices", "validity", "sets", "parts", "joined",
];

/// Hash of the structure of a table: of its file's name, and of everything in it but the values of parameters, of the sets
/// too, and the bounds of the box; and of the files of its family and its parts, where they are beside it. The order of entries counts,
/// comments and layout of the table do not.
pub(crate) fn of_table(
    file_name: &str,
    text: &str,
    scripts: &[Vec<u8>],
) -> Result<String, Unreadable> {
    let text = Text::parse(text.to_owned())?;
    let mut shape = format!("{file_name:?}, ");
    for script in scripts {
        // Byte by byte, whatever its encoding; its line ends are those that git gave it.
        for line in script.split(|&byte| byte == b'\n') {
            let line = line.strip_suffix(b"\r").unwrap_or(line);
            shape.push_str(&format!("{}\\n", line.escape_ascii()));
        }
        shape.push_str(", ");
    }
    table(&mut shape, &mut Vec::new(), text.root());
    Ok(sha256(&shape))
}

/// Hash of what derives: the Python package with its locked packages, and the version of the IR's schema.
pub(crate) fn of_generator() -> String {
    hash_of(python::sources())
}

fn hash_of<'a>(sources: impl Iterator<Item = &'a str>) -> String {
    let mut all = format!("{SCHEMA_VERSION}");
    for source in sources {
        // The line ends are those that git gave the files.
        all.push_str(&format!(", {:?}", source.replace("\r\n", "\n")));
    }
    sha256(&all)
}

fn table<'a>(shape: &mut String, path: &mut Vec<&'a str>, content: &'a dyn TableLike) {
    shape.push('{');
    for (key, item) in content.iter() {
        shape.push_str(&format!("{key:?}: "));
        path.push(key);
        match item {
            Item::Value(value) => self::value(shape, path, value),
            Item::None => {}
            Item::Table(inner) => table(shape, path, inner),
            Item::ArrayOfTables(array) => shape.push_str(&format!("{:?}", array.to_string())),
        }
        path.pop();
        shape.push_str(", ");
    }
    shape.push('}');
}

fn value<'a>(shape: &mut String, path: &mut Vec<&'a str>, value: &'a Value) {
    match value {
        Value::InlineTable(inner) => table(shape, path, inner),
        _ if is_number(value) && is_free(path) => shape.push('#'),
        // Each with a mark of its type: a date is no text of the same letters.
        // In a text of several lines the ends are those that git gave the file.
        Value::String(text) => shape.push_str(&format!("{:?}", text.value().replace("\r\n", "\n"))),
        Value::Integer(number) => shape.push_str(&format!("i{}", number.value())),
        Value::Float(number) => shape.push_str(&format!("f{:?}", number.value())),
        Value::Boolean(flag) => shape.push_str(&format!("b{}", flag.value())),
        Value::Datetime(time) => shape.push_str(&format!("d{}", time.value())),
        Value::Array(array) => {
            shape.push('[');
            for element in array {
                self::value(shape, path, element);
                shape.push_str(", ");
            }
            shape.push(']');
        }
    }
}

/// A finite number. Whatever else stands in its place is the derivation's to refuse.
fn is_number(value: &Value) -> bool {
    value.is_integer() || value.as_float().is_some_and(f64::is_finite)
}

/// Whether a number may stand at this place that the derivation does not read but to check it.
fn is_free(path: &[&str]) -> bool {
    match path {
        [section, _, "value"] => !PLAIN.contains(section),
        ["validity", _, "min" | "max"] | ["sets", _, _, _, "value"] => true,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::{hash_of, of_table};

    const TABLE: &str = "[table]\nname = \"t\"\nmodels = [\"a\", \"b\"]\nuncertainty = 0.1\n[sources]\ns = \"1979-05-27\"\n\
        [C_L]\n\"alpha\" = { value = 1.5, unit = \"1/rad\", uncertainty = 0.2 }\n\"1\" = { value = 2, unit = \"1\" }\n\
        [validity]\nv = { min = 1.0, max = 2.0, unit = \"ft/s\" }\n\
        [sets.\"x\".C_L]\n\"alpha\" = { value = 1.5, unit = \"1/rad\" }\n";

    fn hash(text: &str) -> String {
        of_table("t.toml", text, &[b"x = 1".to_vec()]).expect("TOML")
    }

    #[track_caller]
    fn edited(from: &str, to: &str) -> String {
        assert!(TABLE.contains(from), "no {from:?}");
        hash(&TABLE.replacen(from, to, 1))
    }

    #[test]
    fn scripts_count_by_their_bytes_but_not_by_their_line_ends() {
        let of = |script: &[u8]| of_table("t.toml", TABLE, &[script.to_vec()]).expect("TOML");
        // Neither is UTF-8.
        assert_ne!(of(b"a = '\xe4'\n"), of(b"a = '\xf6'\n"));
        assert_ne!(of(b"a\nb"), of(b"a\\nb"));
        assert_eq!(of(b"a\nb\n"), of(b"a\r\nb\r\n"));
        let text = TABLE.replace("s = \"1979-05-27\"", "s = \"\"\"one\ntwo\"\"\"");
        assert_eq!(hash(&text), hash(&text.replace('\n', "\r\n")));
        assert_ne!(hash(&text), hash(TABLE));
    }

    #[test]
    fn values_comments_and_layout_do_not_count() {
        for (from, to) in [
            ("value = 1.5", "value = 0.0"),
            ("value = 1.5", "value = -1e300"),
            ("value = 2", "value = 2.5"),
            ("min = 1.0", "min = 7"),
            ("max = 2.0", "max = 7.0"),
            (
                "\n[sets.\"x\".C_L]\n\"alpha\" = { value = 1.5",
                "\n[sets.\"x\".C_L]\n\"alpha\" = { value = 9.5",
            ),
            ("[C_L]\n", "# why\n[C_L] # so\n\n"),
            (
                "\"1\" = { value = 2, unit = \"1\" }",
                "\"1\" . value = 2\n\"1\".unit = \"1\"",
            ),
        ] {
            assert_eq!(edited(from, to), hash(TABLE), "{from:?} to {to:?}");
        }
    }

    #[test]
    fn everything_else_counts() {
        let mut found = vec![
            hash(TABLE),
            of_table("u.toml", TABLE, &[b"x = 1".to_vec()]).expect("TOML"),
        ];
        found.push(of_table("t.toml", TABLE, &[b"x = 2".to_vec()]).expect("TOML"));
        for (from, to) in [
            ("name = \"t\"", "name = \"u\""),
            ("[\"a\", \"b\"]", "[\"b\", \"a\"]"),
            ("[\"a\", \"b\"]", "[\"a\"]"),
            ("uncertainty = 0.1", "uncertainty = 0.3"),
            ("uncertainty = 0.2", "uncertainty = 0.3"),
            (", uncertainty = 0.2", ""),
            ("\"1979-05-27\"", "1979-05-27"),
            ("1979-05-27", "1979-05-28"),
            ("\"alpha\" =", "\"alpha^2\" ="),
            ("\"1/rad\"", "\"1/deg\""),
            ("value = 1.5", "value = nan"),
            ("value = 1.5", "value = inf"),
            ("value = 1.5", "value = \"1.5\""),
            ("value = 1.5", "value = true"),
            ("value = 1.5", "value = [1.5]"),
            ("value = 1.5", "valu = 1.5"),
            ("value = 2, unit = \"1\"", "unit = \"1\", value = 2"),
            ("v = {", "w = {"),
            ("[sets.\"x\"", "[sets.\"y\""),
            ("[sets.\"x\".C_L]", "[sets.\"x\".C_D]"),
            ("\n[validity]", "\n[D]\n[validity]"),
        ] {
            found.push(edited(from, to));
        }
        // The order of entries is the order of terms and fields.
        let (alpha, one) = (
            "\"alpha\" = { value = 1.5, unit = \"1/rad\", uncertainty = 0.2 }\n",
            "\"1\" = { value = 2, unit = \"1\" }\n",
        );
        found.push(edited(&format!("{alpha}{one}"), &format!("{one}{alpha}")));
        let count = found.len();
        found.sort();
        found.dedup();
        assert_eq!(found.len(), count);
    }

    #[test]
    fn every_letter_of_the_generator_counts_but_line_ends() {
        let hash = |sources: &[&str]| hash_of(sources.iter().copied());
        let own = hash(&["a.py", "x = 1\n", "casadi==3.8.2\n"]);
        assert_eq!(hash(&["a.py", "x = 1\r\n", "casadi==3.8.2\r\n"]), own);
        for other in [
            ["a.py", "x = 2\n", "casadi==3.8.2\n"],
            ["b.py", "x = 1\n", "casadi==3.8.2\n"],
            ["a.py", "x = 1\n", "casadi==3.8.3\n"],
            ["a.pyx", " = 1\n", "casadi==3.8.2\n"],
        ] {
            assert_ne!(hash(&other), own);
        }
    }
}

//! Random changes of a table.

/// Numbers that are the same on every platform for a seed (SplitMix64).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// A whole number below `end`, which is above 0.
    pub(crate) fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        usize::try_from((mixed ^ (mixed >> 31)) % end as u64).expect("below end")
    }

    fn of<'a, T: ?Sized>(&mut self, list: &[&'a T]) -> &'a T {
        list[self.below(list.len())]
    }
}

const NUMBERS: [&str; 22] = [
    "0",
    "0.0",
    "-0.0",
    "-1.5",
    "1",
    "1e300",
    "-1e300",
    "1e999",
    "1e-320",
    "nan",
    "-nan",
    "inf",
    "-inf",
    "true",
    "\"1\"",
    "1_000",
    "0x10",
    "99999999999999999999",
    "1979-05-27",
    "07:32",
    "[1.0]",
    "{ }",
];
const UNITS: [&str; 26] = [
    "1",
    "ft",
    "m",
    "rad",
    "deg",
    "s",
    "1/rad",
    "1/deg",
    "1/rad^1",
    "slug/ft",
    "kg/m",
    "lb/slug",
    "ft/s^2",
    "deg/s",
    "ft*deg/s/ft",
    "rad^0",
    "1/rads",
    "rad^2/deg",
    "deg^2/deg",
    "rad*deg/deg",
    "(ft*slug)^0.5",
    "(slug*ft)^0.50",
    "(ft*slug)^.5",
    "",
    " ft",
    "lb/ft/rad",
];
const WORDS: [&str; 28] = [
    "published",
    "derived",
    "Published",
    "guessed",
    "assumed",
    "plate",
    "parker2007",
    "free",
    "slaved",
    "none",
    "flat",
    "spherical",
    "shared",
    "moment",
    "si",
    "ft-slug-s-rad",
    "SI",
    "audit",
    "fn",
    "dcom",
    "com",
    "é",
    "section5.1",
    "section5.3",
    "nominal",
    "hessian-pattern",
    "mode1",
    "a\\u202e",
];
const ADDED: [&str; 14] = [
    "uncertanty = 0.1",
    "uncertainty = -0.1",
    "uncertainty = 0",
    "uncertainty = nan",
    "uncertainty = true",
    "source = \"nobody\"",
    "source = 1",
    "status = \"Derived\"",
    "status = \"derived\"",
    "Unit = \"1\"",
    "value.x = 1",
    "\"\\u0007\" = 1",
    "min = 0",
    "\"\" = 0",
];
const LINES: [&str; 24] = [
    "\"alpha^1\" = { value = 9.9, unit = \"1/rad\" }",
    "\"alpha*phi\" = { value = 9.9, unit = \"1/rad\" }",
    "\"alpha * delta_e\" = { value = 9.9, unit = \"1/rad^2\" }",
    "\"delta_e*delta_e\" = { value = 0, unit = \"1/rad^2\" }",
    "\"alpha^5*alpha^6\" = { value = 9.9, unit = \"1/rad^11\" }",
    "\"alpha^01\" = { value = 9.9, unit = \"1/rad\" }",
    "\"0\" = { value = 9.9, unit = \"1\" }",
    "\"1\" = { value = 9.9, unit = \"1\" }",
    "\"eta_1*eta_2\" = { value = 9.9, unit = \"1\" }",
    "alpha = 3",
    "alpha.value = 3",
    "M = { value = 500.0, unit = \"slug/ft\" }",
    "m = { value = 500.0, unit = \"slug/ft\" }",
    "eta = { min = -2.0, max = 2.0, unit = \"(ft*slug)^0.5\" }",
    "omega_4 = { value = 19.7437, unit = \"rad/s\" }",
    "unknown = \"text\"",
    "[extra]",
    "[C_N_4]",
    "[[C_L]]",
    "[sets.other]",
    "[sets.other.vehicle]",
    "[sets.\"section5-3\".modes]",
    "[sets.other.choices]",
    "[sets.other.C_L]\n\"delta_c\" = { value = 0.0, unit = \"1/rad\" }",
];
const MODELS: [&str; 9] = [
    "com",
    "com_rigid",
    "dcom",
    "sdcom",
    "sdcom_printed",
    "sdcom_gust",
    "flexible_mode",
    "sdcm",
    "",
];
const CHARACTERS: &str = "aZ_09.\"'={}[]#,*^/- \n\t\\\u{e9}\u{7}\u{feff}";

/// The table after a change.
pub(crate) fn changed(text: &str, random: &mut Random) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let at = line_of_substance(&lines, random);
    match random.below(14) {
        0 => drop(lines.remove(at)),
        1 => lines.insert(at, lines[at].clone()),
        2 => {
            let other = lines[random.below(lines.len())].clone();
            lines.insert(at, other);
        }
        3 => lines.insert(at, random.of(&LINES).to_owned()),
        4 => lines[at] = character_changed(&lines[at], random),
        5 => lines[at] = cased(&lines[at], random),
        6 => lines[at] = listed(&lines[at], random),
        7 => lines[at] = key_taken(&lines[at], &lines, random),
        8 => lines[at] = shortened(&lines[at], random),
        9 => lines[at] = lengthened(&lines[at], random),
        10 | 11 => replace(&mut lines, random, is_number, &NUMBERS),
        _ => replace_texts(&mut lines, random),
    }
    lines.join("\n") + "\n"
}

/// A line that is not empty and not a comment.
fn line_of_substance(lines: &[String], random: &mut Random) -> usize {
    loop {
        let at = random.below(lines.len());
        if !lines[at].is_empty() && !lines[at].starts_with('#') {
            return at;
        }
    }
}

fn character_changed(line: &str, random: &mut Random) -> String {
    let mut characters: Vec<char> = line.chars().collect();
    let at = random.below(characters.len());
    let known: Vec<char> = CHARACTERS.chars().collect();
    let other = known[random.below(known.len())];
    match random.below(3) {
        0 => drop(characters.remove(at)),
        1 => characters.insert(at, other),
        _ => characters[at] = other,
    }
    characters.into_iter().collect()
}

/// With a letter of the key in the other case.
fn cased(line: &str, random: &mut Random) -> String {
    let end = line.find(['=', ']']).unwrap_or(line.len());
    let letters: Vec<usize> = (0..end)
        .filter(|&at| line.as_bytes()[at].is_ascii_alphabetic())
        .collect();
    let mut bytes = line.as_bytes().to_vec();
    if !letters.is_empty() {
        bytes[letters[random.below(letters.len())]] ^= b' ';
    }
    String::from_utf8(bytes).expect("letters alone changed")
}

/// With other models, if it lists models.
fn listed(line: &str, random: &mut Random) -> String {
    if !line.starts_with("models") && random.below(8) > 0 {
        return cased(line, random);
    }
    let count = random.below(5);
    let names: Vec<String> = (0..count)
        .map(|_| format!("{:?}", random.of(&MODELS)))
        .collect();
    format!("models = [{}]", names.join(", "))
}

/// With the key of another line.
fn key_taken(line: &str, lines: &[String], random: &mut Random) -> String {
    let other = &lines[line_of_substance(lines, random)];
    match (line.split_once(" = "), other.split_once(" = ")) {
        (Some((_, value)), Some((key, _))) => format!("{key} = {value}"),
        _ => other.clone(),
    }
}

/// Without a part between commas.
fn shortened(line: &str, random: &mut Random) -> String {
    let mut parts: Vec<&str> = line.split(", ").collect();
    parts.remove(random.below(parts.len()));
    parts.join(", ")
}

/// With a part more in the inline table.
fn lengthened(line: &str, random: &mut Random) -> String {
    let added = random.of(&ADDED);
    match random.below(10) {
        0 => line.replacen(" }", ", }", 1),
        _ => line.replacen(" }", &format!(", {added} }}"), 1),
    }
}

fn is_number(word: &str) -> bool {
    word.starts_with(|c: char| c.is_ascii_digit() || c == '-')
}

/// A number in place of another.
fn replace(lines: &mut [String], random: &mut Random, wanted: fn(&str) -> bool, others: &[&str]) {
    let with = |line: &String| line.contains('=') && line.split([' ', ',']).any(wanted);
    let places: Vec<usize> = (0..lines.len()).filter(|&at| with(&lines[at])).collect();
    let line = &mut lines[places[random.below(places.len())]];
    let words: Vec<&str> = line.split([' ', ',']).filter(|word| wanted(word)).collect();
    let word = words[random.below(words.len())].to_owned();
    *line = line.replacen(&word, random.of(others), 1);
}

/// Another text in place of one between quotes.
fn replace_texts(lines: &mut [String], random: &mut Random) {
    let with = |line: &String| line.matches('"').count() > 1;
    let places: Vec<usize> = (0..lines.len()).filter(|&at| with(&lines[at])).collect();
    let line = &mut lines[places[random.below(places.len())]];
    let mut parts: Vec<String> = line.split('"').map(str::to_owned).collect();
    let at = 1 + 2 * random.below((parts.len() - 1) / 2);
    let is_unit = parts[at - 1].ends_with("unit = ");
    let others: &[&str] = if is_unit && random.below(8) > 0 {
        &UNITS
    } else {
        &WORDS
    };
    parts[at] = random.of(others).to_owned();
    *line = parts.join("\"");
}

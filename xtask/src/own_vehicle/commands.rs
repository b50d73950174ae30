//! What the programs are asked, and what must hold of their answers.

use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::shell;

// Command lines, and below each facts of its JSON: `pointer = value`, `pointer ~ value` for a number of five digits, or
// `#pointer = length` of a list or an object.

/// Two flexible modes and a set `heavy`.
pub(super) const TWO_MODES: &str = r##"
trim --model sdcom --set heavy
    /converged = true; /set = "heavy"; #/eta = 2; #/state = 7; /in_validity_box = true
trim --model dcom
    /converged = true; /set = "nominal"; #/eta = 2; #/state = 9
trim --model dcom --table tables-of-own-models/two_mode.toml --set heavy
    /converged = true; /set = "heavy"
linearize --model dcom --outputs theta
    /outputs = ["theta"]; #/A = 9; /C = [[0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0]]
poles --model dcom
    #/poles = 9; /modes/8/name = "flexible 2"
poles --model sdcom --set heavy
    #/poles = 7; /modes/6/name = "coloured noise 2"
lqr --model sdcom --set heavy --out gains.json
    #/gain = 2; #/gain/0 = 7
montecarlo --model sdcom --set heavy --feedback gains.json --members 16 --t-end 0.5 --dt 0.01 --disperse
    /members = 16; /lost = 0; /dispersed = true; /feedback = true; /scheme = "splitting"
montecarlo --model dcom --members 16 --t-end 0.2 --dt 0.01
    /members = 16; /lost = 0; /scheme = "heun"; #/mean = 9
rare --model sdcom --set heavy --feedback gains.json --t-end 0.3 --dt 0.01 --passes chi_2=0.05 --effort 20 --repetitions 10
    /state = "chi_2"; /repetitions = 10; /complete = true
covariance --model sdcom --t-end 0.2 --dt 0.01 --members 32
    /members = 32; #/times/0/linear_std = 7
disperse --model sdcom --members 30
    /members = 30; /complete = true
simulate --model dcom --set heavy --stochastic --t-end 0.2 --dt 0.01 --out flight.csv
    /steps = 20; #/final_state = 9
"##;

/// One model of a family, with a mode more than the table of the built-in family has.
pub(super) const FOUR_MODE: &str = r##"
trim --model dcom
    /converged = true; #/eta = 4; /in_validity_box = true
"##;

/// Equations of a built-in family in a family of its own.
pub(super) const PARKER_CANARD: &str = r##"
trim --input delta_c=2deg
    /converged = true; /in_validity_box = true
poles --inputs phi,delta_e,delta_c
    #/inputs = 3
"##;

/// One model of a family, without flexible modes and without noise.
pub(super) const COM_RIGID_ALONE: &str = r##"
trim --model com_rigid
    /converged = true; #/state = 5
poles --model com_rigid
    #/poles = 5
"##;

/// Nothing of it flies, and nothing drives it but its input. At 10 degrees the weight of 2 slug at 3 ft needs 33.52 lb ft.
pub(super) const PENDULUM: &str = r##"
trim --model pendulum --angle 10
    /converged = true; /input/torque = 33.521790903988204; #/outputs = 1
linearize --model pendulum --outputs height,angle
    #/C = 2
poles --model pendulum
    /modes/0/name = "swing"; #/poles = 2; #/zeros = 0
lqr --model pendulum --set light --out pendulum.json
    #/gain = 1
montecarlo --model pendulum --set light --feedback pendulum.json --members 16 --t-end 1 --dt 0.01 --disperse --state-std angle=1deg
    /members = 16; /lost = 0; /feedback = true
covariance --model pendulum --state-std angle=1deg --t-end 1 --dt 0.05 --members 30
    #/times/0/linear_std = 2
disperse --model pendulum --members 30
    /trimmed = 30
simulate --model pendulum --initial angle=5deg --t-end 1 --dt 0.01 --out swing.csv
    /steps = 100
"##;

/// One state, one input, one output, no curve fit, no noise. 1 m/s flows in, 0.5 /s of the level flows out.
pub(super) const TANK: &str = r##"
trim --model tank
    /converged = true; /state/level = 2.0
poles --model tank
    #/poles = 1; #/zeros = 0
linearize --model tank
    /A = [[-0.5]]; /B = [[1.0]]; /C = [[1.0]]
lqr --model tank --state-deviation level=0.1 --input-deviation valve=0.1
    #/gain = 1; #/gain/0 = 1
montecarlo --model tank --members 16 --t-end 1 --dt 0.01 --disperse
    /members = 16; /lost = 0; #/mean = 1
disperse --model tank --members 30
    /trimmed = 30
simulate --model tank --t-end 1 --dt 0.01 --out level.csv
    /steps = 100; #/final_state = 1
"##;

/// Six degrees of freedom, in level flight and in a turn.
pub(super) const SIX_DOF: &str = r##"
trim --bank 30
    /converged = true; #/state = 13; /in_validity_box = true
poles
    #/poles = 13; /modes/0/name = "heading"
lqr --bank 30 --out turn.json
    #/gain = 4; #/gain/0 = 13
montecarlo --bank 30 --feedback turn.json --members 16 --t-end 1 --dt 0.01 --disperse --state-std beta=1deg
    /members = 16; /lost = 0; /feedback = true
disperse --members 30
    /trimmed = 29
covariance --state-std alpha=0.1deg --t-end 1 --dt 0.05 --members 30
    #/times/0/linear_std = 13
"##;

/// The published trim of the winged cone: alpha 0.0312 rad, throttle 0.1762, elevator -0.0069 rad. Its thrust goes over to another
/// formula where the throttle is 1, which the engine of 5 rad/s and damping 0.7 reaches half way from 0.5 to 1.5 at 0.2856118 s.
pub(super) const WINGED_CONE: &str = r##"
trim --model winged_cone --velocity 15060 --altitude 110000
    /converged = true; /state/alpha ~ 0.031227; /input/beta_command ~ 0.17619; /input/delta_e ~ -0.0069454
poles
    #/poles = 7
simulate --initial beta=0.5 --input beta_command=1.5 --tolerance 1e-9 --t-end 1 --dt 0.1 --out engine.csv
    /steps = 10; #/adaptive/boundaries = 1; /adaptive/boundaries/0/boundary = "thrust_coefficient_boundary"; /adaptive/boundaries/0/time ~ 0.28561
"##;

/// As computed. Published, coarsely rounded: alpha 0.0315 rad, throttle 0.183, elevator -0.0066 rad.
pub(super) const WANG_STENGEL: &str = r##"
trim --model wang_stengel --velocity 15060 --altitude 110000
    /converged = true; /state/alpha ~ 0.031225; /input/beta_command ~ 0.17619; /input/delta_e ~ -0.0069465
montecarlo --members 1000 --t-end 1 --dt 0.01 --disperse
    /members = 1000; /lost = 0; #/mean = 7
"##;

/// Gusts join the examples: at rest they change no trim, and they drive every member of its own.
pub(super) const GUSTY: &str = r##"
trim --model gusty_cone --velocity 15060 --altitude 110000
    /converged = true; /state/alpha ~ 0.031227; /state/gust_first = 0.0; /input/delta_e ~ -0.0069454
poles --model gusty_cone
    #/poles = 9; /modes/5/name = "gust"
montecarlo --model gusty_cone --members 1000 --t-end 1 --dt 0.01
    /members = 1000; /lost = 0; #/mean = 9
trim --model gusty_wang_stengel --velocity 15060 --altitude 110000
    /converged = true; /state/alpha ~ 0.031225
montecarlo --model gusty_wang_stengel --members 1000 --t-end 1 --dt 0.01
    /members = 1000; /lost = 0; #/mean = 8
montecarlo --model winged_cone --members 16 --t-end 1 --dt 0.01 --disperse
    /members = 16; /lost = 0; #/mean = 7
"##;

/// A program over models of its own, in a folder for what it writes.
pub(super) struct Own {
    program: PathBuf,
    folder: PathBuf,
}

impl Own {
    pub(super) fn new(name: &str, folder: &Path) -> Self {
        let file = format!("{name}{}", std::env::consts::EXE_SUFFIX);
        Self {
            program: shell::target().join("debug").join(file),
            folder: folder.to_owned(),
        }
    }

    /// Holds its help to exactly these models.
    pub(super) fn knows(&self, models: &[&str]) -> Result<(), String> {
        let help = self.ask("--help")?;
        let named = |command: &&str| help.contains(&format!("\n  {command} "));
        if let Some(missing) = COMMANDS.iter().find(|command| !named(command)) {
            return Err(format!("error: --help has no {missing}:\n{help}"));
        }
        let help = self.ask("trim --help")?;
        let found = values(&help, "--model <MODEL>");
        if found == models {
            Ok(())
        } else {
            Err(format!(
                "error: --help has the models {found:?}, not {models:?}"
            ))
        }
    }

    /// Asks, and holds the answers to the facts below each question.
    pub(super) fn answers(&self, questions: &str) -> Result<(), String> {
        let (mut asked, mut json) = ("", Value::Null);
        for line in questions.trim().lines() {
            let Some(facts) = line.strip_prefix("    ") else {
                println!("  {line}");
                (asked, json) = (line, self.json(line)?);
                continue;
            };
            for fact in facts.split("; ") {
                holds(&json, fact)
                    .map_err(|found| format!("error: {asked}: not {fact}, but {found}"))?;
            }
        }
        Ok(())
    }

    /// What a command answers with `--json`.
    pub(super) fn json(&self, line: &str) -> Result<Value, String> {
        let answer = self.ask(&format!("{line} --json"))?;
        serde_json::from_str(&answer).map_err(|error| format!("error: {line}: {error}\n{answer}"))
    }

    /// Holds a command to being refused with this message.
    pub(super) fn refuses(&self, line: &str, message: &str) -> Result<(), String> {
        match self.ask(line) {
            Err(said) if said.contains(message) => Ok(()),
            Err(said) | Ok(said) => Err(format!("error: {line}: not {message:?}, but\n{said}")),
        }
    }

    /// Runs a command that must end well.
    pub(super) fn does(&self, line: &str) -> Result<(), String> {
        self.ask(line).map(drop)
    }

    fn ask(&self, line: &str) -> Result<String, String> {
        let mut command = shell::program(&self.program);
        command.current_dir(&self.folder);
        shell::output(command.args(line.split_whitespace()))
    }
}

/// The general commands.
const COMMANDS: [&str; 9] = [
    "covariance",
    "disperse",
    "linearize",
    "lqr",
    "montecarlo",
    "poles",
    "rare",
    "simulate",
    "trim",
];

/// The values of a flag that a long help lists below it.
fn values<'a>(help: &'a str, flag: &str) -> Vec<&'a str> {
    let after = help.lines().skip_while(|line| line.trim() != flag).skip(1);
    let of_flag = after.take_while(|line| !line.trim_start().starts_with("--"));
    let items = of_flag.filter_map(|line| line.trim_start().strip_prefix("- "));
    items.filter_map(|item| item.split(':').next()).collect()
}

/// Holds a fact against JSON; what was found instead.
fn holds(json: &Value, fact: &str) -> Result<(), String> {
    if let Some((pointer, expected)) = fact.split_once(" ~ ") {
        return is_near(json, pointer, expected);
    }
    let (pointer, expected) = fact.split_once(" = ").ok_or("no fact")?;
    let found = match pointer.strip_prefix('#') {
        None => json.pointer(pointer).cloned(),
        Some(pointer) => match json.pointer(pointer) {
            Some(Value::Array(items)) => Some(items.len().into()),
            Some(Value::Object(items)) => Some(items.len().into()),
            _ => None,
        },
    };
    let expected: Value = serde_json::from_str(expected).map_err(|error| error.to_string())?;
    match found {
        Some(found) if found == expected => Ok(()),
        Some(found) => Err(found.to_string()),
        None => Err("nothing".to_owned()),
    }
}

/// Compares a number with one that is rounded to five digits.
fn is_near(json: &Value, pointer: &str, expected: &str) -> Result<(), String> {
    const TOLERANCE: f64 = 5e-5;
    let found = json.pointer(pointer).and_then(Value::as_f64);
    let found = found.ok_or("no number")?;
    let expected: f64 = expected.parse().map_err(|_| "no fact")?;
    if (found - expected).abs() <= TOLERANCE * expected.abs() {
        Ok(())
    } else {
        Err(found.to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::{holds, values};
    use serde_json::json;

    #[test]
    fn facts_are_held_against_json() {
        let json = json!({"a": [1, 2], "b": {"c": true}});
        for fact in ["/a = [1, 2]", "#/a = 2", "#/b = 1", "/b/c = true"] {
            assert_eq!(holds(&json, fact), Ok(()), "{fact}");
        }
        assert_eq!(holds(&json, "#/a = 3"), Err("2".to_owned()));
        assert_eq!(holds(&json, "/d = 3"), Err("nothing".to_owned()));
    }

    #[test]
    fn a_number_is_compared_with_a_rounded_one() {
        let json = json!({"a": 0.031_227_4});
        assert_eq!(holds(&json, "/a ~ 0.031227"), Ok(()));
        assert!(holds(&json, "/a ~ 0.031237").is_err());
        assert!(holds(&json, "/b ~ 1").is_err());
    }

    #[test]
    fn only_the_values_of_the_flag_are_read() {
        let help = "Usage: ahv --model <MODEL>\n  --model <MODEL>\n   Model\n\n   Possible values:\n   - a: one\n   - b: two\n\n  --set <NAME>\n   - c: three\n";
        assert_eq!(values(help, "--model <MODEL>"), ["a", "b"]);
        assert!(values(help, "--other").is_empty());
    }
}

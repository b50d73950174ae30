//! Extreme but valid tables and flags: a number, or an error that says why there is none. Never NaN or an infinity.
#![forbid(unsafe_code)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Digits of the longest number that a person reads.
const MOST_DIGITS: usize = 40;

/// A command, with `OUT` for a place that does not exist yet.
type Case = Vec<String>;

fn case(line: &str) -> Case {
    line.split_whitespace().map(str::to_owned).collect()
}

/// Every command that takes a table, small.
const COMMANDS: [&str; 11] = [
    "trim --model MODEL",
    "trim --model MODEL --json",
    "trim --model MODEL --map 2x2 --out OUT",
    "poles --model MODEL --out OUT",
    "linearize --model MODEL --out OUT/a.csv",
    "lqr --model MODEL --out OUT/gains.json",
    "simulate --model MODEL --t-end 0.05 --dt 0.01 --out OUT/flight.csv",
    "disperse --model MODEL --members 30 --out OUT",
    "covariance --model MODEL --members 30 --t-end 0.1 --dt 0.01 --out OUT",
    "montecarlo --model MODEL --members 8 --t-end 0.1 --dt 0.01 --disperse --out OUT",
    "rare --model MODEL --t-end 0.1 --dt 0.01 --passes alpha=2deg --effort 16 --repetitions 10",
];

/// Flags at the ends of what numbers can be.
const FLAGS: [&str; 36] = [
    "trim --model com --velocity 1e300",
    "trim --model com --velocity 1e-300",
    "trim --model com --altitude=-1e300",
    "trim --model com --altitude 1e300",
    "trim --model dcom --input delta_c=1e300deg --canard free",
    "trim --model com --map 2x2 --altitude 1e300 --out OUT",
    "poles --model com --velocity 1e-300 --out OUT",
    "lqr --model sdcom --state-deviation altitude=1e-300ft",
    "lqr --model sdcom --input-deviation phi=1e300",
    "simulate --model com --t-end 1e-300 --dt 1e-300 --out OUT/f.csv",
    "simulate --model com --t-end 1 --dt 1e-300 --out OUT/f.csv",
    "simulate --model com --t-end 0.1 --dt 0.1 --initial velocity=1e-300ft/s --out OUT/f.csv",
    "simulate --model sdcom --t-end 0.1 --dt 0.1 --input phi=1e300 --out OUT/f.csv",
    "montecarlo --model sdcom --members 8 --t-end 1e300 --dt 1e300 --out OUT",
    "montecarlo --model sdcom --members 8 --t-end 1e-300 --dt 1e-300 --out OUT",
    "montecarlo --model sdcom --members 8 --t-end 0.1 --dt 1e-300",
    "montecarlo --model sdcom --members 8 --t-end 0.1 --dt 0.1 --state-std altitude=1e307ft --out OUT",
    "montecarlo --model sdcom --members 8 --t-end 0.1 --dt 0.1 --state-std alpha=-1e-300deg",
    "montecarlo --model sdcom --members 8 --t-end 0.1 --dt 0.1 --limit alpha=1e300deg..-1e300deg",
    "rare --model sdcom --t-end 0.1 --dt 0.01 --passes alpha=1e300deg --effort 16 --repetitions 10",
    "rare --model sdcom --t-end 0.1 --dt 0.01 --passes chi_1=1e-300 --effort 16 --repetitions 10",
    "covariance --model sdcom --members 30 --t-end 1e-300 --dt 1e-300 --out OUT",
    "covariance --model sdcom --members 30 --t-end 100 --dt 20 --out OUT",
    "reduce --omega 1e-300,1e300,1 --zeta 1e-300,1e300,1 --sigma 1e300,1e-300,1 --runs 100 --t-end 1e-3 --dt 1e-3 --out OUT",
    "reduce --t-end 1e-300 --dt 1e-300 --runs 100 --out OUT",
    "reduce --t-end 1e308",
    "reduce --dt 1e-300",
    "reduce --omega 20 --zeta 1e150 --sigma 100 --runs 30 --out OUT",
    "reduce --omega 1e-200 --zeta nan --sigma inf --runs 30",
    "covariance --model sdcom --t-end 1e308",
    "covariance --model sdcom --t-end 1e308 --dt 1e308 --members 30 --out OUT",
    "trim --model com --altitude=-1e300 --json",
    "simulate --model com --t-end 0.1 --dt 0.1 --initial velocity=0ft/s --out OUT/f.csv",
    "simulate --model com --t-end 0.2 --dt 0.1 --initial altitude=-1e300ft --out OUT/f.csv",
    "disperse --model dcom --members 30 --group lift=c_l_alpha,c_l_0:nan --out OUT",
    "montecarlo --model sdcom --members 2 --t-end 0.1 --dt 0.01 --out OUT",
];

/// Changes of a line of the table of DCOM: what the line begins with, in which section, and what it becomes.
const TABLES: [(&str, &str, &str, &str); 8] = [
    (
        "tiny",
        "C_M",
        "\"eta_3\"",
        "\"eta_3\" = { value = 1e-308, unit = \"1/(ft*slug)^0.5\" }",
    ),
    (
        "wide",
        "C_L",
        "\"alpha\"",
        "\"alpha\" = { value = 4.7, unit = \"1/rad\", uncertainty = 1e308 }",
    ),
    (
        "steep",
        "C_L",
        "\"alpha\"",
        "\"alpha\" = { value = 1e150, unit = \"1/rad\" }",
    ),
    (
        "light",
        "vehicle",
        "m",
        "m = { value = 1e-300, unit = \"slug/ft\" }",
    ),
    (
        "heavy",
        "vehicle",
        "m",
        "m = { value = 1e300, unit = \"slug/ft\" }",
    ),
    (
        "soft",
        "modes",
        "omega_1",
        "omega_1 = { value = 1e-150, unit = \"rad/s\" }",
    ),
    (
        "stiff",
        "modes",
        "omega_1",
        "omega_1 = { value = 1e150, unit = \"rad/s\" }",
    ),
    (
        "loud",
        "noise",
        "sigma_1",
        "sigma_1 = { value = 1e300, unit = \"(ft*slug)^0.5/s^1.5\" }",
    ),
];

/// The table of DCOM with one entry changed, and all others as they are.
fn table((name, section, key, entry): (&str, &str, &str, &str), folder: &Path) -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let text = fs::read_to_string(root.join("generator/tables/dcom.toml")).expect("a table");
    let mut inside = false;
    let mut changed = 0;
    let lines = text.lines().map(|line| {
        if line.starts_with('[') {
            inside = line.trim() == format!("[{section}]");
        }
        let own = line.split('=').next().is_some_and(|own| own.trim() == key);
        if inside && own {
            changed += 1;
            return entry.to_owned();
        }
        line.to_owned()
    });
    let lines: Vec<String> = lines.collect();
    assert_eq!(changed, 1, "{name}");
    let path = folder.join(format!("{name}.toml"));
    fs::write(&path, lines.join("\n")).expect("written");
    path
}

fn cases(folder: &Path) -> Vec<Case> {
    let mut cases: Vec<Case> = FLAGS.iter().map(|line| case(line)).collect();
    for change in TABLES {
        let path = table(change, folder);
        for command in COMMANDS {
            let model = if command.starts_with("rare") || command.starts_with("montecarlo") {
                "sdcom"
            } else {
                "dcom"
            };
            let mut case = case(&command.replace("MODEL", model));
            case.extend(["--table".to_owned(), path.display().to_string()]);
            cases.push(case);
        }
    }
    cases.push(case("track --runs 2 --controller lqr --out OUT"));
    cases
}

/// Where a text holds a number that is none, or one of hundreds of digits.
fn fault(text: &str) -> Option<String> {
    let words = text.split(|c: char| !c.is_alphanumeric());
    let bad = |word: &&str| {
        let word = word.to_lowercase();
        ["nan", "inf", "infinity"].contains(&word.as_str())
            || (word.len() > MOST_DIGITS && word.chars().all(|c| c.is_ascii_digit()))
    };
    words.into_iter().find(bad).map(str::to_owned)
}

/// What is wrong with what a case does.
fn problem(case: &Case, place: &Path) -> Option<String> {
    let out = place.display().to_string();
    if case.iter().any(|word| word.starts_with("OUT/")) {
        fs::create_dir(place).expect("a folder");
    }
    let arguments = case.iter().map(|word| word.replace("OUT", &out));
    let output = Command::new(env!("CARGO_BIN_EXE_ahv"))
        .args(arguments)
        .output();
    let output = output.expect("ahv starts");
    let errors = String::from_utf8_lossy(&output.stderr);
    if !matches!(output.status.code(), Some(0 | 2 | 3)) || errors.contains("panicked") {
        return Some(format!("{:?}: {errors}", output.status));
    }
    // What was typed is told as it was typed.
    let typed = |word: &String| case.iter().any(|part| part.contains(word.as_str()));
    if let Some(word) = fault(&errors).filter(|word| !typed(word)) {
        return Some(format!("stderr holds {word}: {errors}"));
    }
    if let Some(word) = fault(&String::from_utf8_lossy(&output.stdout)) {
        return Some(format!("stdout holds {word}"));
    }
    let files = fs::read_dir(place).into_iter().flatten().flatten();
    files.into_iter().find_map(|file| {
        let text = fs::read_to_string(file.path()).expect("text");
        let word = fault(&text)?;
        Some(format!("{} holds {word}", file.path().display()))
    })
}

#[test]
fn no_command_writes_a_number_that_is_none() {
    let folder = tempfile::tempdir().expect("a folder");
    let cases = cases(folder.path());
    let next = AtomicUsize::new(0);
    let threads = std::thread::available_parallelism().map_or(2, usize::from);
    let work = || {
        let mut problems = Vec::new();
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(case) = cases.get(index) else {
                return problems;
            };
            let place = folder.path().join(index.to_string());
            if let Some(problem) = problem(case, &place) {
                problems.push(format!("ahv {}\n  {problem}", case.join(" ")));
            }
        }
    };
    let problems: Vec<String> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        workers
            .into_iter()
            .flat_map(|it| it.join().expect("no panic"))
            .collect()
    });
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

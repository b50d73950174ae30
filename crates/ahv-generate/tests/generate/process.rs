//! Generation as a process: its exit codes, its signals and its environment.

use crate::scratch::{LINE, Scratch, args};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use std::{env, fs, process, thread};

/// What [`Scratch::process`] runs; nothing in the run of all tests.
#[test]
fn generate_in_a_process() {
    if let Ok(line) = env::var(LINE) {
        let line: Vec<&str> = line.split_whitespace().collect();
        process::exit(ahv_generate::run(&args(&line)).into());
    }
}

fn is_alive(pid: &str) -> bool {
    let mut kill = Command::new("kill");
    let done = kill.args(["-0", pid]).stderr(Stdio::null()).status();
    done.expect("kill runs").success()
}

fn eventually(what: &str, done: impl Fn() -> bool) {
    let start = Instant::now();
    while !done() {
        assert!(start.elapsed() < Duration::from_secs(30), "{what}");
        thread::sleep(Duration::from_millis(5));
    }
}

/// The program ends with what it started, and leaves nothing of what it wrote.
#[test]
fn a_signal_ends_the_work_and_what_is_temporary() {
    for (signal, code) in [("INT", 130), ("TERM", 143), ("HUP", 129)] {
        let mut scratch = Scratch::small();
        let started = scratch.path("started");
        let derive = format!(
            "echo $$ > {0}.part; mv {0}.part {0}; exec sleep 60",
            started.display()
        );
        scratch.use_python(scratch.interpreter("3 11", "", &derive));
        let before = scratch.snapshot("generated");
        let child = scratch
            .process(&["--derive"])
            .stderr(Stdio::piped())
            .spawn();
        let child = child.expect("it runs");
        eventually("no derivation", || started.exists());
        let python = fs::read_to_string(&started).expect("a number");
        assert!(is_alive(python.trim()));
        assert!(!is_empty(&scratch.path("temporary")));

        let mut kill = Command::new("kill");
        kill.arg(format!("-{signal}")).arg(child.id().to_string());
        assert!(kill.status().expect("kill runs").success());
        let output = child.wait_with_output().expect("it ends");
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{said}");
        assert!(said.contains("interrupted: no file was changed"), "{said}");
        eventually("the derivation goes on", || !is_alive(python.trim()));
        assert!(
            is_empty(&scratch.path("temporary")),
            "a temporary file is left"
        );
        assert!(before == scratch.snapshot("generated"));
    }
}

/// A process that is killed cannot end what it started: that sees the pipe close.
#[test]
fn a_derivation_ends_with_a_process_that_is_killed() {
    let mut scratch = Scratch::small();
    let started = scratch.path("started");
    let derive = format!(
        "echo $$ > {0}.part; mv {0}.part {0}; exec cat",
        started.display()
    );
    scratch.use_python(scratch.interpreter("3 11", "", &derive));
    let mut child = scratch.process(&["--derive"]).spawn().expect("it runs");
    eventually("no derivation", || started.exists());
    let python = fs::read_to_string(&started).expect("a number");
    thread::sleep(Duration::from_millis(100));
    assert!(is_alive(python.trim()), "it has no pipe");
    child.kill().expect("killed");
    child.wait().expect("it ends");
    eventually("the derivation goes on", || !is_alive(python.trim()));
}

/// Killed without a warning at 50 moments of its work, from the start to the end: each file is the old one or the new one, nearly always
/// all of them, and the next run makes the tree that a whole one makes.
#[test]
fn a_killed_generation_leaves_each_file_old_or_new() {
    const TABLE: &str = "generator/tables/com.toml";
    let scratch = Scratch::small();
    let before = scratch.snapshot("generated");
    scratch.edit(TABLE, "max = 11000.0", "max = 12000.0");
    let start = Instant::now();
    let done = scratch.process(&[]).stdout(Stdio::null()).status();
    let whole = start.elapsed();
    assert!(done.expect("it runs").success());
    let after = scratch.snapshot("generated");
    let changed: Vec<usize> = (0..before.len())
        .filter(|&it| before[it] != after[it])
        .collect();
    assert!(
        before.len() == after.len() && changed.len() > 2,
        "{changed:?}"
    );
    let (mut olds, mut news, mut random) = (0, 0, 19_u64);
    for _ in 0..50 {
        for &index in &changed {
            fs::write(&before[index].0, &before[index].1).expect("written");
        }
        let mut child = scratch.process(&[]);
        let mut child = child.stdout(Stdio::null()).spawn().expect("it runs");
        random = random
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        // Now and then after the end, however fast a run is.
        let share = (random >> 33) as f64 / f64::from(1_u32 << 31);
        thread::sleep(whole.mul_f64(1.2 * share));
        // It may have ended.
        let _ = child.kill();
        child.wait().expect("it ends");
        let left = scratch.snapshot("generated");
        let is_temporary = |path: &Path| {
            let name = path.file_name().unwrap_or_default();
            name.to_string_lossy().starts_with(".ahv-")
        };
        let (temporary, left): (Vec<_>, Vec<_>) =
            left.into_iter().partition(|it| is_temporary(&it.0));
        temporary
            .iter()
            .for_each(|it| fs::remove_file(&it.0).expect("removed"));
        assert_eq!(left.len(), before.len());
        for (index, file) in left.iter().enumerate() {
            let is_whole = *file == before[index] || *file == after[index];
            assert!(is_whole, "{} is neither old nor new", file.0.display());
        }
        olds += usize::from(left == before);
        news += usize::from(left == after);
        scratch.generate(&[]).expect("generated");
        assert!(scratch.snapshot("generated") == after, "it does not mend");
    }
    // A kill between two of the renames leaves both kinds: they take a thousandth of a run.
    assert!(
        olds > 5 && news > 0 && olds + news >= 48,
        "{olds} old, {news} new"
    );
}

/// A crash of the interpreter in a family is a fault at its line.
#[test]
fn a_crash_of_the_interpreter_names_the_family() {
    let mut scratch = Scratch::small();
    scratch.write(
        "generator/tables/crash.py",
        "import ctypes\nctypes.string_at(0)\n",
    );
    let family = scratch.path("generator/tables/crash.py");
    let report = format!(
        "Fatal Python error: Segmentation fault\n\nCurrent thread 0x1 (most recent call first):\n         \x20 File \"/lib/ctypes/__init__.py\", line 519 in string_at\n  File \"{}\", line 2 in <module>\n",
        family.display()
    );
    scratch.write("report", report);
    let derive = format!(
        "cat {} >&2; kill -SEGV $$",
        scratch.path("report").display()
    );
    scratch.use_python(scratch.interpreter("3 11", "", &derive));
    let output = scratch.process(&["--derive"]).output().expect("it runs");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    for part in [
        "the Python interpreter crashed: Segmentation fault",
        "crash.py:2:1",
        "ctypes.string_at(0)",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
}

fn is_empty(folder: &Path) -> bool {
    fs::read_dir(folder).expect("a folder").next().is_none()
}

/// Watching generates on save, however an editor saves, shows what is wrong, and ends with Ctrl-C.
#[test]
fn watching_generates_on_save() {
    let scratch = Scratch::small();
    let table = "generator/tables/flexible_mode.toml";
    let [out, err] = ["out", "err"].map(|name| scratch.path(name));
    let file = |path: &Path| fs::File::create(path).expect("made");
    let mut command = scratch.process(&["--watch"]);
    command
        .env("AHV_PYTHON", "/nowhere/python")
        .stdout(file(&out))
        .stderr(file(&err));
    let mut child = command.spawn().expect("it runs");
    let said = |path: &Path, what: &str, times: usize| {
        let text = || fs::read_to_string(path).unwrap_or_default();
        eventually(&format!("{what:?} {times} times"), || {
            text().matches(what).count() == times
        });
    };
    said(&err, "watching generator/tables; Ctrl-C ends\n", 1);
    said(&out, "nothing changed (derive ", 1);

    // In place, by a file that is renamed, and by one that goes first.
    scratch.edit(table, "value = 0.7,", "value = 0.71,");
    said(&out, "code: 1 file, +1 −1\n", 1);
    scratch.write(
        "generator/tables/.saved",
        scratch
            .read(table)
            .replace("value = 0.71,", "value = 0.72,"),
    );
    fs::rename(scratch.path("generator/tables/.saved"), scratch.path(table)).expect("renamed");
    said(&out, "code: 1 file, +1 −1\n", 2);
    let text = scratch.read(table);
    fs::remove_file(scratch.path(table)).expect("removed");
    thread::sleep(Duration::from_millis(200));
    scratch.write(table, text.replace("value = 0.72,", "value = 0.73,"));
    said(&out, "code: 1 file, +1 −1\n", 3);
    assert!(
        scratch
            .read("generated/src/flexible_mode/nominal.rs")
            .contains("zeta: 0.73")
    );

    scratch.write(table, text.replace("value = 0.72,", "value = -1.0,"));
    said(&err, "flexible_mode.toml:29:18]", 1);
    scratch.write(table, text.replace("value = 0.72,", "value = 0.74,"));
    said(&out, "code: 1 file, +1 −1\n", 4);
    said(&err, "watching generator/tables", 6);

    let pid = child.id().to_string();
    let kill = Command::new("kill").args(["-INT", &pid]).status();
    assert!(kill.expect("kill runs").success());
    assert_eq!(child.wait().expect("it ends").code(), Some(130));
    assert!(is_empty(&scratch.path("temporary")));
}

/// Without any place for a cache, for nothing is kept.
#[test]
fn the_check_from_the_ir_needs_no_home() {
    let scratch = Scratch::small();
    let mut command = scratch.process(&["--check", "--from-ir"]);
    for variable in ["HOME", "AHV_CACHE_DIR", "XDG_CACHE_HOME", "AHV_PYTHON"] {
        command.env_remove(variable);
    }
    let output = command.output().expect("it runs");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    command.env(LINE, "--check");
    let output = command.output().expect("it runs");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("HOME is not set"), "{said}");
}

/// The interpreter sees none of the variables that change a Python, but the search path of its caller.
#[test]
fn the_variables_of_python_do_not_reach_it() {
    let mut scratch = Scratch::small();
    let ir = scratch.path("../ir");
    let seen = scratch.path("seen");
    let derive = format!(
        "env | grep '^PYTHON' > {}; cp {}/*.json \"$8\"",
        seen.display(),
        ir.display()
    );
    scratch.use_python(scratch.interpreter("3 11", "", &derive));
    let mut command = scratch.process(&["--check"]);
    for variable in [
        "PYTHONHOME",
        "PYTHONINSPECT",
        "PYTHONIOENCODING",
        "PYTHONSTARTUP",
    ] {
        command.env(variable, "hostile");
    }
    let output = command
        .env("PYTHONPATH", "/modules")
        .output()
        .expect("it runs");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert_eq!(
        fs::read_to_string(seen).expect("a list"),
        "PYTHONPATH=/modules\n"
    );
}

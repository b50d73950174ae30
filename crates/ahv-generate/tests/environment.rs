//! Python environments of ahv's own. Needs a Python 3.11 or newer with venv.

use std::fs;
use std::path::Path;
use std::thread;
use std::time::SystemTime;

use ahv_generate::{Surroundings, environment};

/// Locked requirements that need no network.
const NOTHING: &str = "--no-index\n";
const NOWHERE: &str = "--no-index\nahv-no-such-package==1.0 \\\n    --hash=sha256:\
    0000000000000000000000000000000000000000000000000000000000000000\n";

fn surroundings(folder: &Path) -> Surroundings {
    Surroundings {
        current_dir: folder.to_owned(),
        python: None,
        cache: Some(folder.join("cache")),
    }
}

fn made(python: &Path) -> SystemTime {
    let list = python
        .ancestors()
        .nth(2)
        .expect("the environment")
        .join("requirements.txt");
    fs::metadata(list)
        .and_then(|it| it.modified())
        .expect("a list of requirements")
}

#[test]
fn an_environment_is_made_once_and_whole() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let surroundings = surroundings(folder.path());
    let set_up = || environment("a test", NOTHING, &surroundings).expect("set up");

    // Two at once: one makes it, the other waits and takes it.
    let (first, second) = thread::scope(|scope| {
        let (first, second) = (scope.spawn(set_up), scope.spawn(set_up));
        (
            first.join().expect("no panic"),
            second.join().expect("no panic"),
        )
    });
    assert_eq!(first, second);
    assert!(first.is_file());
    let stamp = made(&first);
    assert_eq!(set_up(), first);
    assert_eq!(made(&first), stamp, "made again without need");

    // A set-up that was killed left no marker: what there is cannot be trusted.
    fs::remove_file(first.ancestors().nth(2).expect("there").join("complete")).expect("removed");
    assert_eq!(set_up(), first);
    assert_ne!(
        made(&first),
        stamp,
        "a broken-off set-up was taken for a finished one"
    );
}

#[test]
fn packages_that_cannot_be_had_leave_no_environment() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let surroundings = surroundings(folder.path());
    for _ in 0..2 {
        let failure = environment("a test", NOWHERE, &surroundings).expect_err("no package");
        let text = failure.to_string();
        assert!(
            text.starts_with("error: pip could not install the Python packages: "),
            "{text}"
        );
        assert!(text.contains("ahv-no-such-package"), "{text}");
        assert!(text.contains("is there a network?"), "{text}");
    }
}

#[test]
fn a_cache_that_cannot_be_written_is_named() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("cache"), "a file").expect("written");
    let failure = environment("a test", NOTHING, &surroundings(folder.path()));
    let text = failure.expect_err("no folder").to_string();
    assert!(
        text.starts_with("error: cannot make ") && text.contains("cache"),
        "{text}"
    );
}

//! `ahv montecarlo --resume`, through the real binary.

use std::fs::{self, File};
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::command::{ahv, fail, json, stderr};

/// Three blocks of members, the last of which is not whole; a shard each.
const LINE: &str =
    "montecarlo --model sdcom --members 5000 --t-end 0.05 --dt 0.01 --limit alpha=-1deg..2deg";
const SHARDS: [&str; 3] = ["--resume", "--shard-members", "2048"];

fn resumed(folder: &Path, more: &[&str]) -> Value {
    let out = folder.display().to_string();
    json(&[&[LINE, "--out", &out], &SHARDS[..], more].concat())
}

fn shard(folder: &Path, number: u32) -> PathBuf {
    folder.join(format!("shards/shard-{number:06}.parquet"))
}

/// The outcome without what the machine decides.
fn plain(mut told: Value) -> Value {
    let object = told.as_object_mut().expect("an object");
    for name in ["seconds", "member_steps_per_second", "threads"] {
        object.remove(name).expect(name);
    }
    told
}

#[test]
fn shards_have_the_bits_of_one_run_and_stay() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    let whole = tempfile::tempdir().expect("a folder");
    let out = whole.path().display().to_string();
    let expected = plain(json(&[LINE, "--out", &out]));
    assert_eq!(plain(resumed(path, &["--threads", "1"])), expected);
    for name in [
        "snapshots.csv",
        "histograms.csv",
        "limits.csv",
        "members.csv",
    ] {
        let [one, two] = [path, whole.path()].map(|it| fs::read(it.join(name)).expect(name));
        assert!(one == two, "{name}");
    }
    let times = || {
        [0, 1, 2].map(|it| {
            fs::metadata(shard(path, it))
                .and_then(|it| it.modified())
                .expect("a shard")
        })
    };
    let before = times();
    assert_eq!(plain(resumed(path, &[])), expected);
    assert_eq!(times(), before);

    // One that is cut off, one with a changed byte, and one that is not there are flown again.
    let bytes = fs::read(shard(path, 0)).expect("a shard");
    fs::write(shard(path, 0), &bytes[..bytes.len() / 2]).expect("written");
    let mut bytes = fs::read(shard(path, 1)).expect("a shard");
    let place = bytes.len() / 8;
    bytes[place] ^= 4;
    fs::write(shard(path, 1), bytes).expect("written");
    fs::remove_file(shard(path, 2)).expect("removed");
    let out = path.display().to_string();
    let again = ahv(&[&[LINE, "--json", "--out", &out], &SHARDS[..]].concat());
    let told = serde_json::from_slice(&again.stdout).expect("JSON");
    assert_eq!(plain(told), expected);
    let notes = stderr(&again);
    assert_eq!(notes.matches("is flown again").count(), 2, "{notes}");
    assert_eq!(
        times()
            .iter()
            .zip(before)
            .filter(|(it, was)| *it > was)
            .count(),
        3
    );
}

#[test]
fn another_option_is_refused_and_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().display().to_string();
    resumed(folder.path(), &[]);
    for (more, named) in [
        (&["--seed", "7"][..], "--seed was 0 and is 7"),
        (
            &["--set", "section5.3"],
            "values of the table (SHA-256) was",
        ),
        (&["--scheme", "heun"], "--scheme was splitting and is heun"),
        (&["--canard", "free"], "--canard was"),
    ] {
        let words = [&[LINE, "--out", &out], &SHARDS[..], more].concat();
        fail(&words, 2, &["begun with other options", named, &out]);
    }
    let words = [LINE, "--out", &out, "--resume", "--shard-members", "4096"];
    fail(&words, 2, &["--shard-members was 2048 and is 4096"]);
    fail(
        &[LINE, "--out", &out, "--resume", "--shard-members", "1000"],
        2,
        &["multiple of 2048"],
    );
    fail(&[LINE, "--resume"], 2, &["--out"]);
    fs::write(folder.path().join("campaign.json"), "{").expect("written");
    let words = [&[LINE, "--out", &out], &SHARDS[..]].concat();
    fail(&words, 2, &["campaign.json is no manifest of a campaign"]);
}

#[test]
fn one_campaign_leads_a_folder() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().display().to_string();
    let file = File::create(folder.path().join("campaign.lock")).expect("a file");
    file.lock().expect("locked");
    let words = [&[LINE, "--out", &out], &SHARDS[..]].concat();
    fail(&words, 2, &["another campaign is at work in", &out]);
    drop(file);
    resumed(folder.path(), &[]);
}

#[cfg(unix)]
#[test]
fn no_link_is_followed() {
    for name in ["shards", "campaign.lock", "campaign.json"] {
        let [folder, other] = [(), ()].map(|()| tempfile::tempdir().expect("a folder"));
        let out = folder.path().display().to_string();
        std::os::unix::fs::symlink(other.path(), folder.path().join(name)).expect("a link");
        let words = [&[LINE, "--out", &out], &SHARDS[..]].concat();
        fail(&words, 2, &[name, "it is a link"]);
        assert_eq!(fs::read_dir(other.path()).expect("a folder").count(), 0);
    }
}

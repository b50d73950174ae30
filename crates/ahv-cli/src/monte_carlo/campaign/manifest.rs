//! `campaign.json`: what a campaign flies, and in which shards.

use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use ahv_analysis::monte_carlo::Reference;
use ahv_core::Bounds;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::super::Arguments;
use super::no_link;
use crate::failure::Failure;
use crate::flights::Ready;
use crate::labels::Labels;
use crate::output;

const NAME: &str = "campaign.json";

/// An option as it is compared: its name, and what it says.
pub(super) type Choice = (String, String);

/// Members of a shard.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Range {
    /// The file, from the folder of the campaign.
    pub(super) file: String,
    pub(super) first: u64,
    pub(super) members: u64,
}

/// What a campaign flies, and in which shards.
#[derive(Serialize, Deserialize)]
pub(super) struct Manifest {
    options: Vec<Choice>,
    members: u64,
    shards: Vec<Range>,
    reference: Reference,
}

/// What decides the bits of the members, and where they are kept: nothing of it may change.
pub(super) fn options(arguments: &Arguments, ready: &Ready) -> Vec<Choice> {
    let (vehicle, experiment) = (&ready.vehicle, &ready.experiment);
    let named = |labels: Labels, values: &[f64]| -> String {
        let pairs = labels
            .iter()
            .zip(values)
            .filter(|(_, value)| **value != 0.0);
        let pairs = pairs.map(|((name, unit), value)| format!("{name}={value:?} {unit}"));
        pairs.collect::<Vec<_>>().join(", ")
    };
    let steps: Vec<String> = experiment.snapshots.iter().map(u64::to_string).collect();
    let all = vec![
        ("version of ahv", env!("CARGO_PKG_VERSION").to_owned()),
        ("--model", vehicle.name().to_owned()),
        ("--set", vehicle.set.to_string()),
        ("--units", vehicle.units.name().to_owned()),
        ("values of the table (SHA-256)", vehicle.fingerprint()),
        (
            "validity box (SHA-256)",
            hash(&bounds(&experiment.watched[0])),
        ),
        (
            "state at the start",
            named(vehicle.states, &experiment.state[0]),
        ),
        (
            "input at the start",
            named(vehicle.inputs, &experiment.input[0]),
        ),
        ("--state-std", named(vehicle.states, &experiment.state[1])),
        ("--input-std", named(vehicle.inputs, &experiment.input[1])),
        (
            "--disperse",
            match &experiment.dispersion {
                None => "off".to_owned(),
                Some(_) => hash(&format!("{:?}", vehicle.uncertainty)),
            },
        ),
        (
            "--feedback",
            match &experiment.feedback {
                None => "off".to_owned(),
                Some(feedback) => hash(&format!("{feedback:?}")),
            },
        ),
        (
            "--limit",
            experiment
                .watched
                .get(1)
                .map_or_else(String::new, |it| bounds(it)),
        ),
        ("--scheme", experiment.scheme.name().to_owned()),
        ("--mode", experiment.mode.name().to_owned()),
        ("--dt", format!("{:?} s", experiment.dt)),
        ("--t-end and --snapshots (steps)", steps.join(" ")),
        ("--seed", experiment.seed.to_string()),
        ("--members", arguments.members.to_string()),
        (
            "--shard-members",
            arguments.campaign.shard_members.to_string(),
        ),
    ];
    let choices = vehicle.choices.iter();
    let choices: Vec<Choice> = choices
        .map(|(name, chosen)| {
            let flag = crate::vehicle::hyphenated(name);
            (
                format!("--{flag}"),
                chosen.unwrap_or("of the table").to_owned(),
            )
        })
        .collect();
    let all = all
        .into_iter()
        .map(|(name, value)| (name.to_owned(), value));
    all.chain(choices).collect()
}

fn bounds(bounds: &[Bounds]) -> String {
    let ends = bounds
        .iter()
        .map(|it| format!("{:?}..{:?}", it.min, it.max));
    ends.collect::<Vec<_>>().join(", ")
}

fn hash(text: &str) -> String {
    let digest = Sha256::digest(text.as_bytes());
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

impl Manifest {
    pub(super) fn new(arguments: &Arguments, options: Vec<Choice>, reference: Reference) -> Self {
        let (members, each) = (arguments.members, arguments.campaign.shard_members);
        let shards = (0..members.div_ceil(each)).map(|number| Range {
            file: format!("shards/shard-{number:06}.parquet"),
            first: number * each,
            members: each.min(members - number * each),
        });
        Self {
            options,
            members,
            shards: shards.collect(),
            reference,
        }
    }

    /// That of a folder, if it has one.
    pub(super) fn read(folder: &Path) -> Result<Option<Self>, Failure> {
        let path = folder.join(NAME);
        no_link(&path)?;
        let text = match fs::read_to_string(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            Err(error) => {
                let why = output::plain(&error);
                return Err(Failure::Request(format!(
                    "cannot read {}: {why}",
                    path.display()
                )));
            }
        };
        let read = serde_json::from_str::<Self>(&text).map_err(|error| error.to_string());
        let sound = read.and_then(|read| match read.is_sound() {
            true => Ok(read),
            false => Err("its shards do not follow one another".to_owned()),
        });
        sound.map(Some).map_err(|why| {
            Failure::Request(format!(
                "{} is no manifest of a campaign: {why}; name another folder, or remove it",
                path.display()
            ))
        })
    }

    /// Whether its shards hold all members, each in a file of the folder.
    fn is_sound(&self) -> bool {
        let mut next = 0;
        let follows = |(number, shard): (usize, &Range)| {
            let follows = shard.first == next && shard.members > 0;
            next = shard.first.saturating_add(shard.members);
            follows && shard.file == format!("shards/shard-{number:06}.parquet")
        };
        let all = self.shards.iter().enumerate().all(follows);
        all && next == self.members && !self.shards.is_empty()
    }

    pub(super) fn write(&self, folder: &Path) -> Result<(), Failure> {
        output::write(&folder.join(NAME), output::json(self)? + "\n")
    }

    /// Itself, if these are its options.
    pub(super) fn of_options(self, asked: &[Choice], folder: &Path) -> Result<Self, Failure> {
        let value = |all: &[Choice], name: &str| {
            let found = all.iter().find(|(known, _)| known == name);
            found.map_or("not there", |(_, value)| value).to_owned()
        };
        let names = self.options.iter().chain(asked).map(|(name, _)| name);
        let mut differences: Vec<String> = Vec::new();
        for name in names {
            let (was, is) = (value(&self.options, name), value(asked, name));
            let difference = match [&*was, &*is].map(|it| if it.is_empty() { "none" } else { it }) {
                [was, is] if was != is => format!("{name} was {was} and is {is}"),
                _ => continue,
            };
            if !differences.contains(&difference) {
                differences.push(difference);
            }
        }
        if differences.is_empty() {
            return Ok(self);
        }
        Err(Failure::Request(format!(
            "--out: the campaign in {} was begun with other options: {}. Ask for what it was begun with, or name another folder",
            folder.display(),
            differences.join("; ")
        )))
    }

    pub(super) fn options(&self) -> &[Choice] {
        &self.options
    }

    pub(super) fn members(&self) -> u64 {
        self.members
    }

    pub(super) fn shards(&self) -> &[Range] {
        &self.shards
    }

    pub(super) fn reference(&self) -> &Reference {
        &self.reference
    }
}

//! A campaign: members in shards, each a file of its own, with which another call or another machine goes on.
//!
//! ```text
//! DIR/campaign.json                   options, shards, and what sums are taken about
//! DIR/campaign.lock                   locked while a call leads the campaign
//! DIR/shards/shard-000000.parquet     members 0 to …, and their sums
//! ```
//!
//! A shard takes its place when it is whole. A call that leads reads the shards in their order, flies those that are missing or
//! damaged, and joins their sums: the outcome has the bits of a run of all members.

mod manifest;
mod shard;

use std::fs::{File, OpenOptions, TryLockError};
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::Instant;

use ahv_analysis::monte_carlo::{BLOCK, Engine, MemberRecord, MonteCarloError, Outcome, Tally};
use ahv_analysis::ordered::Control;
use clap::Args;
use serde::Serialize;

use super::Arguments;
use crate::failure::{Failure, complain};
use crate::flights::{Ready, watched};
use crate::output;
use crate::progress::{Progress, Work};
use manifest::Manifest;
use shard::Flown;

/// How a campaign goes on.
#[derive(Args)]
pub(super) struct CampaignArguments {
    /// Fly in shards that stay in the folder of --out, and go on with those that are there
    #[arg(long, requires = "out", conflicts_with = "control_variate")]
    pub(super) resume: bool,

    /// Make the folder of a campaign ready, print its shards as JSON, those that are missing too, and fly none
    #[arg(long, requires = "out", conflicts_with_all = ["resume", "shard", "control_variate"])]
    pub(super) plan: bool,

    /// Fly one shard of a campaign that --plan has made ready, by its number
    #[arg(long, value_name = "K", requires = "out", conflicts_with_all = ["resume", "control_variate"])]
    pub(super) shard: Option<u64>,

    /// Members of a shard, a multiple of 2048
    #[arg(long, value_name = "N", default_value_t = 32 * BLOCK, value_parser = whole_blocks)]
    pub(super) shard_members: u64,
}

fn whole_blocks(text: &str) -> Result<u64, String> {
    let members = text
        .parse::<u64>()
        .ok()
        .filter(|it| *it > 0 && it.is_multiple_of(BLOCK));
    members.ok_or_else(|| format!("it must be a multiple of {BLOCK}, such as {}", 32 * BLOCK))
}

/// The right to lead the campaign of a folder, for as long as it lives.
#[derive(Debug)]
pub struct Lock(#[allow(dead_code, reason = "it is locked while it is open")] File);

impl Lock {
    /// Takes it.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] if another call leads a campaign there, or the file cannot be made.
    pub fn take(folder: &Path) -> Result<Self, Failure> {
        output::folder(folder)?;
        let path = folder.join("campaign.lock");
        no_link(&path)?;
        let file = OpenOptions::new()
            .write(true)
            .create(true)
            .truncate(false)
            .open(&path);
        let file = file.map_err(|error| output::cannot_write(&path, &output::plain(&error)))?;
        match file.try_lock() {
            Ok(()) => Ok(Self(file)),
            Err(TryLockError::WouldBlock) => Err(Failure::Request(format!(
                "--out: another campaign is at work in {}; wait for its end, or name another folder",
                folder.display()
            ))),
            Err(TryLockError::Error(error)) => {
                Err(output::cannot_write(&path, &output::plain(&error)))
            }
        }
    }
}

fn no_link(path: &Path) -> Result<(), Failure> {
    if path.symlink_metadata().is_ok_and(|it| it.is_symlink()) {
        let why = "it is a link; a campaign keeps its files in its own folder";
        return Err(output::cannot_write(path, why));
    }
    Ok(())
}

/// A campaign in its folder.
pub(super) struct Campaign<'r> {
    ready: &'r Ready,
    folder: PathBuf,
    manifest: Manifest,
    /// Who leads holds it to the end.
    _lock: Option<Lock>,
}

/// What `--plan` prints.
#[derive(Serialize)]
struct Plan<'a> {
    folder: &'a Path,
    members: u64,
    shard_members: u64,
    shards: usize,
    missing: Vec<usize>,
}

impl Arguments {
    /// Does what a flag of campaigns asks for; `None` where the flights are reported after it.
    ///
    /// # Errors
    ///
    /// Those of the campaign.
    pub(super) fn part_of_campaign(&self, ready: &Ready) -> Result<Option<()>, Failure> {
        let Some(folder) = &self.out else {
            return Ok(None);
        };
        if self.campaign.plan {
            let campaign = Campaign::lead(self, ready, folder)?;
            let missing = campaign.missing()?;
            output::print_json(&Plan {
                folder,
                members: self.members,
                shard_members: self.campaign.shard_members,
                shards: campaign.manifest.shards().len(),
                missing,
            })?;
            return Ok(Some(()));
        }
        let Some(number) = self.campaign.shard else {
            return Ok(None);
        };
        let campaign = Campaign::join(self, ready, folder)?;
        campaign.one(number)?;
        Ok(Some(()))
    }
}

impl<'r> Campaign<'r> {
    /// Leads the campaign of a folder: begins it where there is none.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] if the folder has one with other options, or another call leads it.
    pub(super) fn lead(
        arguments: &Arguments,
        ready: &'r Ready,
        folder: &Path,
    ) -> Result<Self, Failure> {
        let lock = Lock::take(folder)?;
        let shards = folder.join("shards");
        no_link(&shards)?;
        output::folder(&shards)?;
        let asked = manifest::options(arguments, ready);
        let manifest = match Manifest::read(folder)? {
            Some(manifest) => manifest.of_options(&asked, folder)?,
            None => {
                let threads = ready.threads(arguments.members);
                let progress = Progress::start(Work {
                    command: "montecarlo",
                    unit: "",
                    total: None,
                });
                let reference = watched(progress, |control| {
                    let engine = ready.vehicle.model.engine(&ready.experiment)?;
                    engine.reference(arguments.members, threads, control)
                })?;
                let manifest = Manifest::new(arguments, asked, reference);
                manifest.write(folder)?;
                manifest
            }
        };
        Ok(Self {
            ready,
            folder: folder.to_owned(),
            manifest,
            _lock: Some(lock),
        })
    }

    /// Works for the campaign that another call leads.
    fn join(arguments: &Arguments, ready: &'r Ready, folder: &Path) -> Result<Self, Failure> {
        let manifest = Manifest::read(folder)?.ok_or_else(|| {
            Failure::Request(format!(
                "--shard: {} holds no campaign; the same command with --plan in the place of --shard makes one",
                folder.display()
            ))
        })?;
        let asked = manifest::options(arguments, ready);
        Ok(Self {
            ready,
            folder: folder.to_owned(),
            manifest: manifest.of_options(&asked, folder)?,
            _lock: None,
        })
    }

    /// Shards that are not there, or of which that much can be seen at once.
    fn missing(&self) -> Result<Vec<usize>, Failure> {
        let mut missing = Vec::new();
        for number in 0..self.manifest.shards().len() {
            let path = self.path(number)?;
            if !shard::is_there(&path, &self.manifest, number) {
                missing.push(number);
            }
        }
        Ok(missing)
    }

    /// Flies one shard, unless it is there.
    fn one(&self, number: u64) -> Result<(), Failure> {
        let count = self.manifest.shards().len();
        let known = usize::try_from(number).ok().filter(|it| *it < count);
        let number = known.ok_or_else(|| {
            Failure::Request(format!(
                "--shard: there is no shard {number}; they are 0 to {}",
                count - 1
            ))
        })?;
        if let Ok(Some(_)) = shard::read(&self.path(number)?, &self.manifest, number, self.ready) {
            return Ok(());
        }
        let members = self.manifest.shards()[number].members;
        let progress = Progress::start(Work {
            command: "montecarlo",
            unit: "member-steps",
            total: Some(members.saturating_mul(self.ready.experiment.steps())),
        });
        watched(progress, |control| {
            let engine = self.ready.vehicle.model.engine(&self.ready.experiment)?;
            Ok(self.fly(&engine, number, control))
        })??;
        Ok(())
    }

    /// Reads the shards, flies those that are missing, and joins all; `list` is given the members of each.
    ///
    /// # Errors
    ///
    /// [`Failure::Interrupted`] if it was stopped; what was flown stays on disk.
    pub(super) fn gather(
        &self,
        engine: &Engine<'_>,
        control: &Control,
        mut list: impl FnMut(u64, &[MemberRecord]),
    ) -> Result<Outcome, Failure> {
        let started = Instant::now();
        let mut tally = Tally::new(&self.ready.experiment, self.manifest.reference().clone());
        for (number, range) in self.manifest.shards().iter().enumerate() {
            let path = self.path(number)?;
            let found = shard::read(&path, &self.manifest, number, self.ready);
            let flown = match found {
                Ok(Some(flown)) => {
                    let steps = range.members.saturating_mul(self.ready.experiment.steps());
                    control.done.fetch_add(steps, Ordering::Relaxed);
                    flown
                }
                Ok(None) => self.fly(engine, number, control)?,
                Err(why) => {
                    complain(&format!("note: {} is flown again: {why}", path.display()));
                    self.fly(engine, number, control)?
                }
            };
            list(range.first, &flown.records);
            tally.join(&flown.records, flown.part);
            if control.stop.load(Ordering::Relaxed) && number + 1 < self.manifest.shards().len() {
                return Err(self.interrupted());
            }
        }
        Ok(tally.outcome(self.manifest.members(), started.elapsed()))
    }

    /// Flies a shard and puts it in its place.
    fn fly(&self, engine: &Engine<'_>, number: usize, control: &Control) -> Result<Flown, Failure> {
        let range = &self.manifest.shards()[number];
        let mut records = Vec::new();
        let part = engine.part(
            range.first..range.first + range.members,
            self.manifest.reference(),
            self.ready.threads(range.members),
            control,
            |_, seen| records.extend(seen.iter().map(without_snapshots)),
        );
        let mut part = part.map_err(|error| match error {
            MonteCarloError::Stopped => self.interrupted(),
            other => Failure::Request(format!("--scheme: {other}")),
        })?;
        if self.manifest.members() > BLOCK {
            part.forget_numbers();
        }
        let flown = Flown { records, part };
        flown.write(&self.path(number)?, &self.manifest, self.ready)?;
        Ok(flown)
    }

    fn interrupted(&self) -> Failure {
        let count = self.manifest.shards().len();
        let there = count - self.missing().map_or(count, |missing| missing.len());
        Failure::Interrupted(format!(
            "interrupted: {there} of {count} shards are in {}; the same command goes on with them",
            self.folder.display()
        ))
    }

    fn path(&self, number: usize) -> Result<PathBuf, Failure> {
        let path = self.folder.join(&self.manifest.shards()[number].file);
        no_link(&path)?;
        Ok(path)
    }
}

/// A member without its states at the snapshots, which are summed in its part.
fn without_snapshots(seen: &MemberRecord) -> MemberRecord {
    MemberRecord {
        companion: Vec::new(),
        states: Vec::new(),
        inputs: Vec::new(),
        last: seen.last.clone(),
        lost: seen.lost,
        left: seen.left.clone(),
    }
}

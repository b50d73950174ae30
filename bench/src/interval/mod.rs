//! What a user pays for an outcome: the standard deviation of the angle of attack in closed loop, known to 1 %.

pub(crate) mod problem;

use std::path::Path;
use std::process::Command;
use std::time::Instant;

use serde::Serialize;
use serde_json::Value;

use crate::commands;
use crate::ensembles::{Ensembles, GXX};
use crate::moments;
use crate::race::{Finish, Outcome, Runner, race};
use crate::setting::Setting;
use crate::table::Table;
use problem::{END, Law, THREADS};

/// Flights of which the 95 % interval of a normal number's standard deviation is 1 % of it wide: 2 · 1.96 / √(2n).
const MEMBERS: usize = 76_832;
/// Of these a turn takes one in so many.
const SHARE: usize = 8;
/// The bias may be a tenth of the interval.
const BIAS: f64 = 1e-3;
/// Steps that are tried, in s, the largest first.
const STEPS: [f64; 5] = [5e-3, 4e-3, 2.5e-3, 2e-3, 1e-3];
/// Flights of which the bias is measured: those of one seed see the same noise, and their difference has little of it.
const PAIRS: usize = 2048;
const SCHEME: &str = "euler-maruyama";
const MODEL: &str = "sdcom";
const QUANTITY: &str = "alpha";
const PEER: &str = "CasADi's step in C++";
const OWN: &str = "ahv";
/// Flights that give `ahv` an interval as narrow by its control variate; whether they do is checked.
const FEW: usize = 512;
/// Width of the interval, as a share of the value.
const WIDTH: f64 = 0.01;

/// What was found.
#[derive(Serialize)]
pub(crate) struct Interval {
    /// The peer, then `ahv` with as many flights, then `ahv` with its control variate, in seconds for all flights.
    pub(crate) finishes: Vec<Finish>,
    rounds: u32,
    /// Step in s.
    step: f64,
    /// Its bias, relative.
    bias: f64,
    /// Greatest difference of a moment, in standard errors.
    standard_errors: f64,
}

/// Lets `program` design the regulator, finds the step, and lets both fly.
pub(crate) fn measure(
    setting: &Setting,
    program: &Path,
    ensembles: Ensembles,
    rounds: u32,
) -> Result<Interval, String> {
    eprintln!("timing an interval in closed loop");
    let gains = setting.out.join("gains.json");
    let mut design = Command::new(program);
    design.args(["lqr", "--model", MODEL, "--out"]).arg(&gains);
    commands::output(&mut design)?;
    let law = Law::read(&commands::read_json(&gains)?).ok_or("error: ahv lqr wrote no gains")?;
    let (step, bias) = step(ensembles, &law)?;

    let fly = |seed| Ok(ensembles.closed_loop(&law, (step, 1), MEMBERS / SHARE, seed));
    let own = |seed, members: usize, share: usize, more: &[&str]| {
        let start = Instant::now();
        let told = own(program, &gains, step, (seed, members), more)?;
        let seconds = start.elapsed().as_secs_f64() * share as f64;
        if members == FEW {
            narrow(&told)?;
        }
        Ok::<_, String>(Outcome {
            seconds,
            values: moments_of(&told)?,
            first: 0.0,
        })
    };
    let plain = |seed| own(seed, MEMBERS / SHARE, SHARE, &[]);
    let controlled = |seed| own(seed, FEW, 1, &["--control-variate"]);
    let ends = |ends: &Vec<_>| moments::of_members::<1>(ends);
    let runners = vec![
        Runner::new(PEER, GXX, 1.0 / SHARE as f64, fly, ends),
        Runner {
            name: OWN,
            how: "the process `ahv montecarlo`, f64, with trim and statistics",
            run: Box::new(plain),
        },
        Runner {
            name: OWN,
            how: "the same with `--control-variate`, 512 flights",
            run: Box::new(controlled),
        },
    ];
    let finishes = race(runners, THREADS, rounds)?;
    let members = (MEMBERS / SHARE) as f64;
    let standard_errors = moments::check("the interval in closed loop", &finishes, members)?;
    Ok(Interval {
        finishes,
        rounds,
        step,
        bias,
        standard_errors,
    })
}

/// The largest step whose bias is small enough, with its bias. The scheme is of first order: what halving a step changes is half of
/// its bias.
fn step(ensembles: Ensembles, law: &Law) -> Result<(f64, f64), String> {
    let deviation = |step, parts| {
        let ends = ensembles.closed_loop(law, (step, parts), PAIRS, 0);
        moments::of_members::<1>(&ends)[1]
    };
    let bias = |step: f64| 2.0 * (deviation(step, 2) / deviation(0.5 * step, 1) - 1.0);
    let mut found = STEPS.iter().map(|&step| (step, bias(step)));
    let found = found.find(|(_, bias)| bias.abs() <= BIAS);
    found.ok_or("error: no step of the interval in closed loop is small enough".to_owned())
}

/// What so many flights of `ahv` tell.
fn own(
    program: &Path,
    gains: &Path,
    step: f64,
    (seed, members): (u64, usize),
    more: &[&str],
) -> Result<Value, String> {
    let mut command = Command::new(program);
    command.args(["montecarlo", "--json", "--model", MODEL, "--feedback"]);
    command.arg(gains).args(more);
    for (option, value) in [
        ("--scheme", SCHEME.to_owned()),
        ("--members", members.to_string()),
        ("--t-end", END.to_string()),
        ("--dt", step.to_string()),
        ("--threads", THREADS.to_string()),
        ("--seed", seed.to_string()),
        // The other looks at the end alone.
        ("--snapshots", "1".to_owned()),
    ] {
        command.args([option, &value]);
    }
    serde_json::from_str(&commands::output(&mut command)?)
        .map_err(|error| format!("error: ahv montecarlo: {error}"))
}

/// Mean and standard deviation of the angle of attack at the end.
fn moments_of(told: &Value) -> Result<Vec<f64>, String> {
    let value = |key: &str| told[key][QUANTITY].as_f64();
    let values = value("mean").zip(value("std"));
    let (mean, deviation) = values.ok_or("error: ahv montecarlo tells no deviation")?;
    Ok(vec![mean, deviation])
}

/// Holds the interval to its width.
fn narrow(told: &Value) -> Result<(), String> {
    let snapshots = told["snapshots"].as_array();
    let last = snapshots.and_then(|it| it.last());
    let of = |key| last.and_then(|last| last["std"][QUANTITY][key].as_f64());
    let width = of("high").zip(of("low")).zip(of("value"));
    let width = width.map(|((high, low), value)| (high - low) / value);
    match width {
        Some(width) if width <= WIDTH => Ok(()),
        _ => Err(format!(
            "error: the interval of ahv is {width:?} of its value wide, not {WIDTH}"
        )),
    }
}

impl Interval {
    /// For people.
    pub(crate) fn table(&self) -> Table {
        let row = |it: &Finish| {
            let (time, ratio) = (it.seconds, it.ratio);
            vec![
                it.candidate.to_owned(),
                it.how.to_owned(),
                format!("{:.1}", time.median),
                format!("{:.1}–{:.1}", time.lower_quartile, time.upper_quartile),
                format!("{:.3}", ratio.median),
                format!("{:.3}–{:.3}", ratio.lower_quartile, ratio.upper_quartile),
            ]
        };
        Table {
            title: "An interval of the angle of attack's standard deviation".to_owned(),
            note: format!(
                "The 95 % interval of σ_α of SDCOM at {END} s, 1 % of it wide, under the regulator of `ahv lqr --model sdcom` through \
                 actuators: {MEMBERS} flights. A turn takes one in {SHARE} of them, and the times are {SHARE} times its own, \
                 which counts the start of `ahv` as often. With its control variate `ahv` has an interval at most as wide of {FEW} flights, which is \
                 checked in each turn; the peer has none, though it could. All by the Euler–Maruyama method at {} ms, the largest of the steps {} ms \
                 at which the bias of σ_α is below a tenth of the interval: {:+.3} %, measured on {PAIRS} flights with the same noise \
                 at this step and at half of it. {THREADS} threads, {} rounds in which each has its turn. Means and standard deviations \
                 over all turns differ by at most {:.1} standard errors.",
                self.step * 1e3,
                STEPS.map(|it| (it * 1e3).to_string()).join(", "),
                self.bias * 100.0,
                self.rounds,
                self.standard_errors
            ),
            columns: vec!["candidate", "how", "s", "quartiles", "ratio", "quartiles"],
            rows: self.finishes.iter().map(row).collect(),
        }
    }
}

//! How often intervals of 95 % hold the truth, against the tables of `docs/monte-carlo.md`.
//!
//! `AHV_COVERAGE_SEEDS` is the number of seeds: few in the gate, 400 in `cargo xtask audit`. The bounds follow from it. With
//! `--nocapture` the tables are printed as the document has them.

use std::collections::BTreeMap;

use crate::common::level;
use ahv_analysis::disperse::{Distribution, Draws};
use ahv_analysis::erased::values;
use ahv_analysis::monte_carlo::{Experiment, Mode, QUANTILES, Scheme, StateSpread};
use ahv_analysis::ordered::Control;
use ahv_analysis::statistics::{Estimate, OpenEstimate, mean_and_std};
use ahv_analysis::trim::trim;
use ahv_core::{GeneratedModel, Vector};
use ahv_integrate::NormalStream;
use ahv_models::{dcom, sdcom};

/// Seeds unless others are asked for.
const SEEDS: u64 = 40;
/// Samples of a law for each seed: they cost less than flights.
const SAMPLES: u64 = 10;
/// Standard errors that a measured coverage may be off: once in 16 000.
const ERRORS: f64 = 4.0;
/// What rounding to 0.1 % in the document adds.
const ROUNDING: f64 = 0.0005;
/// Members of a flight's ensemble in the gate, and in the audit.
const MEMBERS: [u64; 2] = [100, 1000];

fn seeds() -> u64 {
    let given = std::env::var("AHV_COVERAGE_SEEDS").ok();
    given.map_or(SEEDS, |text| text.parse().expect("a number of seeds"))
}

/// Rows of the document's table with this heading: coverages by the first two cells.
fn documented(heading: &str) -> BTreeMap<[String; 2], Vec<f64>> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/monte-carlo.md");
    let text = std::fs::read_to_string(path).expect("the document");
    let rows = text.lines().skip_while(|line| *line != heading);
    let rows = rows.skip(2).take_while(|line| line.starts_with('|'));
    let row = |line: &str| {
        let mut cells = line
            .trim_matches('|')
            .split('|')
            .map(|it| it.trim().to_owned());
        let key = [0; 2].map(|_| cells.next().expect("a cell"));
        let number = |cell: String| cell.trim_end_matches(" %").parse::<f64>();
        (key, cells.filter_map(|cell| number(cell).ok()).collect())
    };
    rows.map(row).collect()
}

/// Trials, and those whose interval holds the truth.
#[derive(Clone, Copy, Default)]
struct Count {
    held: u64,
    trials: u64,
}

impl Count {
    fn add(&mut self, holds: bool) {
        self.held += u64::from(holds);
        self.trials += 1;
    }

    fn share(&self) -> f64 {
        self.held as f64 / self.trials as f64
    }
}

/// Coverages of one row, printed as the document has them and compared with it.
struct Table {
    heading: &'static str,
    rows: Vec<([String; 2], Vec<Count>)>,
}

impl Table {
    fn row(&mut self, name: &str, size: impl ToString, counts: Vec<Count>) {
        self.rows
            .push(([name.to_owned(), size.to_string()], counts));
    }

    fn check(&self) {
        let documented = documented(self.heading);
        println!("{}", self.heading);
        let mut wrong = Vec::new();
        for (key, counts) in &self.rows {
            let cells = counts
                .iter()
                .map(|it| format!("{:.1} %", 100.0 * it.share()));
            let row = cells.collect::<Vec<_>>().join(" | ");
            println!("| {} | {} | {row} |", key[0], key[1]);
            let told = documented.get(key).cloned().unwrap_or_default();
            let agrees = told.len() == counts.len()
                && counts.iter().zip(&told).all(|(count, told)| {
                    let told = told / 100.0;
                    // No number of trials shows that a coverage is exactly 1.
                    let trials = count.trials as f64;
                    let error = ((told * (1.0 - told) + 1.0 / trials) / trials).sqrt();
                    (count.share() - told).abs() <= ERRORS * error + ROUNDING
                });
            if !agrees {
                wrong.push(format!("{key:?}: measured {row}, documented {told:?}"));
            }
        }
        assert!(wrong.is_empty(), "{wrong:#?}");
    }
}

/// A law whose moments and quantiles are known.
struct Law {
    draw: fn(&mut dyn FnMut() -> f64) -> f64,
    mean: f64,
    std: f64,
    /// By share, as [`SHARES`].
    quantiles: [f64; SHARES.len()],
}

const SHARES: [f64; 4] = [0.005, 0.05, 0.5, 0.995];

/// Normal, exponential, and Student's with five degrees of freedom, of kurtosis 3, 9 and 9.
const LAWS: [Law; 3] = [
    Law {
        draw: |normal| normal(),
        mean: 0.0,
        std: 1.0,
        quantiles: [
            -2.575_829_303_548_9,
            -1.644_853_626_951_472,
            0.0,
            2.575_829_303_548_9,
        ],
    },
    Law {
        draw: |normal| 0.5 * (normal().powi(2) + normal().powi(2)),
        mean: 1.0,
        std: 1.0,
        quantiles: [
            0.005_012_541_823_544,
            0.051_293_294_387_550,
            std::f64::consts::LN_2,
            5.298_317_366_548_036,
        ],
    },
    Law {
        draw: |normal| {
            let squares: f64 = (0..5).map(|_| normal().powi(2)).sum();
            normal() / (squares / 5.0).sqrt()
        },
        mean: 0.0,
        std: 1.290_994_448_735_806,
        quantiles: [
            -4.032_142_983_557_536,
            -2.015_048_372_669_157,
            0.0,
            4.032_142_983_557_536,
        ],
    },
];

fn samples(law: &Law, size: usize) -> impl Iterator<Item = Vec<f64>> {
    (0..seeds() * SAMPLES).map(move |seed| {
        let mut stream = NormalStream::new(seed, size as u64, 0);
        let mut next = 0;
        let mut normal = || {
            next += 1;
            stream.normal(next - 1)
        };
        (0..size).map(|_| (law.draw)(&mut normal)).collect()
    })
}

#[test]
fn intervals_of_samples_cover_as_documented() {
    let mut table = Table {
        heading: "| interval of | numbers | normal | skewed | heavy-tailed |",
        rows: Vec::new(),
    };
    for size in [30, 100, 1000] {
        let (mut means, mut stds) = ([Count::default(); 3], [Count::default(); 3]);
        let mut normal = Count::default();
        for (index, law) in LAWS.iter().enumerate() {
            for sample in samples(law, size) {
                let (mean, std) = mean_and_std(&sample);
                let count = size as f64;
                means[index].add(Estimate::of_mean(mean, std, count).holds(law.mean));
                stds[index].add(OpenEstimate::of_sample_std(&sample).holds(law.std));
                if index == 0 {
                    normal.add(Estimate::of_normal_std(std, count).holds(law.std));
                }
            }
        }
        table.row("mean", size, means.to_vec());
        table.row("standard deviation", size, stds.to_vec());
        table.row("standard deviation of normal numbers", size, vec![normal]);
    }
    for size in [40, 100, 500] {
        for (place, share) in SHARES.into_iter().enumerate() {
            let mut counts = [Count::default(); 3];
            for (count, law) in counts.iter_mut().zip(&LAWS) {
                for mut sample in samples(law, size) {
                    sample.sort_by(f64::total_cmp);
                    let estimate = OpenEstimate::of_sorted(&sample, share);
                    count.add(estimate.holds(law.quantiles[place]));
                }
            }
            table.row(
                &format!("{} % quantile", 100.0 * share),
                size,
                counts.to_vec(),
            );
        }
    }
    table.check();
}

/// Members of `trials` that succeed with probability `share`.
fn successes(seed: u64, channel: u64, trials: u64, share_z: f64) -> u64 {
    let mut stream = NormalStream::new(seed, channel, 1);
    (0..trials)
        .map(|trial| u64::from(stream.normal(trial) < share_z))
        .sum()
}

/// Shares by Wilson's formula, and probabilities by splitting: products of shares, each with as many members from every level.
#[test]
fn intervals_of_probabilities_cover_as_documented() {
    let mut table = Table {
        heading: "| interval of the probability | members | coverage |",
        rows: Vec::new(),
    };
    // Of a normal number to be less than this: 1 %, 20 %, 30 %.
    let (one, twenty, thirty) = (
        -2.326_347_874_040_841,
        -0.841_621_233_572_914,
        -0.524_400_512_708_041,
    );
    for (name, limit, probability) in [("1 %", one, 0.01), ("30 %", thirty, 0.3)] {
        let mut count = Count::default();
        for seed in 0..seeds() * SAMPLES {
            let share = Estimate::of_share(successes(seed, 0, 100, limit), 100);
            count.add(share.holds(probability));
        }
        table.row(name, 100, vec![count]);
    }
    for (levels, repetitions, effort) in [(4, 10, 128), (8, 20, 160)] {
        let mut count = Count::default();
        for seed in 0..seeds() * SAMPLES {
            let repetition = |index: u64| {
                let share = |level: u64| {
                    let channel = 1 + index * levels + level;
                    successes(seed, channel, effort, twenty) as f64 / effort as f64
                };
                (0..levels).map(share).product::<f64>()
            };
            let values: Vec<f64> = (0..repetitions).map(repetition).collect();
            let (mean, std) = mean_and_std(&values);
            let estimate = Estimate::of_mean(mean, std, values.len() as f64);
            count.add(estimate.holds(0.2_f64.powi(levels as i32)));
        }
        let name = format!("{levels} levels of 20 %, {repetitions} repetitions");
        table.row(&name, effort, vec![count]);
    }
    table.check();
}

/// What is looked at of a state, in the order of the table's columns.
fn estimates(spread: &StateSpread) -> Option<[OpenEstimate; 4]> {
    let place = |share| QUANTILES.iter().position(|&it| it == share);
    let [low, middle] = [0.005, 0.5].map(|share| spread.quantiles.get(place(share)?).copied());
    let moments = [OpenEstimate::from(spread.mean), spread.std?];
    Some([moments[0], moments[1], low?, middle?])
}

/// Coverage of a state's intervals at the end, with one large ensemble as the truth.
fn flights<M: GeneratedModel>(
    table: &mut Table,
    name: &str,
    states: &[&str],
    experiment: impl Fn(u64) -> Experiment,
) {
    let seeds = seeds();
    let sizes = match (experiment(0).control_variate, seeds > SEEDS) {
        // Fewer have none.
        (true, _) => &MEMBERS[1..],
        (false, true) => &MEMBERS[..],
        (false, false) => &MEMBERS[..1],
    };
    for &members in sizes {
        let run = |seed, members| {
            let experiment = experiment(seed);
            let engine = experiment.engine::<M>().expect("the scheme goes");
            let outcome = engine.run(members, 2, &Control::default());
            let mut snapshots = outcome.expect("flights").snapshots;
            snapshots.pop().expect("a snapshot").states
        };
        let truth = run(u64::MAX / 2, seeds * members);
        let at = |state: &str| M::StateOf::<()>::index_of(state).expect("a state");
        let mut counts = vec![[Count::default(); 4]; states.len()];
        for seed in 0..seeds {
            let spreads = run(seed, members);
            for (counts, state) in counts.iter_mut().zip(states) {
                let [Some(found), Some(truth)] =
                    [&spreads, &truth].map(|it| estimates(&it[at(state)]))
                else {
                    panic!("no estimate of {state}");
                };
                for ((count, found), truth) in counts.iter_mut().zip(found).zip(truth) {
                    count.add(found.holds(truth.value.expect("a value")));
                }
            }
        }
        for (counts, state) in counts.iter().zip(states) {
            table.row(&format!("{name}, {state}"), members, counts.to_vec());
        }
    }
}

#[test]
fn intervals_of_flights_cover_as_documented() {
    let mut table = Table {
        heading: "| flights | members | mean | standard deviation | 0.5 % quantile | median |",
        rows: Vec::new(),
    };
    let calm = held::<sdcom::Model<f64>>(&sdcom::SECTION5_3, Scheme::Splitting, 0.02, 50);
    flights::<sdcom::Model<f64>>(&mut table, "sdcom section5.3, 1 s", &["velocity"], |seed| {
        Experiment {
            seed,
            ..calm.clone()
        }
    });
    let states = ["velocity", "alpha"];
    let name = "sdcom section5.3, 1 s, control variate";
    flights::<sdcom::Model<f64>>(&mut table, name, &states, |seed| Experiment {
        seed,
        control_variate: true,
        ..calm.clone()
    });
    let calm = held::<dcom::Model<f64>>(&dcom::NOMINAL, Scheme::Heun, 4e-3, 125);
    let uncertainty = dcom::SETS[0].uncertainty();
    let states = ["alpha", "pitch_rate"];
    flights::<dcom::Model<f64>>(&mut table, "dcom dispersed, 0.5 s", &states, |seed| {
        let law = Distribution::Uniform;
        let draws = Draws::new(dcom::NOMINAL, uncertainty, law, Vec::new(), seed);
        Experiment {
            dispersion: Some(draws.expect("draws")),
            seed,
            ..calm.clone()
        }
    });
    let name = "dcom dispersed, 0.5 s, control variate";
    flights::<dcom::Model<f64>>(&mut table, name, &states, |seed| {
        let law = Distribution::Uniform;
        let draws = Draws::new(dcom::NOMINAL, uncertainty, law, Vec::new(), seed);
        Experiment {
            dispersion: Some(draws.expect("draws")),
            seed,
            control_variate: true,
            ..calm.clone()
        }
    });
    table.check();
}

/// A model from its trim, at its inputs.
fn held<M: GeneratedModel>(
    parameters: &M::ParametersOf<f64>,
    scheme: Scheme,
    dt: f64,
    steps: u64,
) -> Experiment {
    let rest = trim(&M::with_parameters(parameters), &level::<M>()).expect("it trims");
    Experiment {
        parameters: values(parameters),
        dispersion: None,
        state: [values(&rest.state), vec![0.0; M::State::LEN]],
        input: [values(&rest.input), vec![0.0; M::Input::LEN]],
        feedback: None,
        watched: Vec::new(),
        scheme,
        mode: Mode::Exact,
        dt,
        snapshots: vec![steps],
        seed: 0,
        control_variate: false,
    }
}

//! Fixed steps know their times, and a failure tells its own.
#![forbid(unsafe_code)]

#[path = "common/blow_up.rs"]
mod blow_up;
mod common;

use ahv_core::Vector;
use ahv_integrate::{Failure, Progress, Rk4, TimeGrid};
use blow_up::{BlowUp, ONE, State};

fn grid(begin: f64, end: f64, dt: f64) -> TimeGrid {
    TimeGrid::new(begin, end, dt).expect("few steps")
}

fn fly(grid: &TimeGrid, progress: &mut Progress<State<f64>>) -> Result<(), Failure> {
    while grid.step(progress, |x, _, dt| Rk4::new(dt).step(&BlowUp, x, &ONE))? {}
    Ok(())
}

#[test]
fn a_multiple_of_the_step_has_equal_steps() {
    for (begin, end, dt, steps) in [
        (0.0, 3.0, 0.01, 300),
        (0.0, 0.3, 0.1, 3),
        (0.0, 0.7, 0.001, 700),
        (2.0, 3.0, 1.0, 1),
        (-0.3, 0.3, 0.1, 6),
    ] {
        let grid = grid(begin, end, dt);
        assert_eq!((grid.steps(), grid.dt(), grid.end()), (steps, dt, end));
        assert_eq!(grid.length(steps - 1), dt);
        assert_eq!((grid.time(0), grid.time(steps)), (begin, end));
    }
}

#[test]
fn times_are_free_of_rounding_where_they_can_be() {
    let grid = grid(0.0, 1.0, 0.01);
    let times = [35, 57, 70].map(|step| grid.time(step));
    assert_eq!(times, [0.35, 0.57, 0.7]);
}

#[test]
fn the_last_step_is_shortened() {
    let uneven = grid(0.0, 1.0, 0.3);
    let seen = (uneven.steps(), uneven.length(2), uneven.time(4));
    assert_eq!(seen, (4, 0.3, 1.0));
    assert!((uneven.length(3) - 0.1).abs() < 1e-15);
    let short = grid(0.0, 0.1, 5.0);
    assert_eq!((short.steps(), short.length(0)), (1, 0.1));
}

#[test]
fn a_run_passes_the_times_of_the_grid() {
    let grid = grid(0.5, 1.2, 0.3);
    let mut progress = Progress::new(0.5, ONE);
    let mut seen = Vec::new();
    let step = |x: &mut State<f64>, step, dt| {
        seen.push((step, dt));
        Rk4::new(dt).step(&BlowUp, x, &ONE)
    };
    let mut step = step;
    while grid.step(&mut progress, &mut step).expect("finite") {}
    assert_eq!((progress.time, progress.accepted), (1.2, 3));
    assert!((progress.state.time - 0.7).abs() < 1e-15);
    assert_eq!(seen[..2], [(0, 0.3), (1, 0.3)]);
    assert!(seen[2].0 == 2 && (seen[2].1 - 0.1).abs() < 1e-15);
}

#[test]
fn a_failure_tells_time_name_and_value_and_leaves_the_last_good_state() {
    let grid = grid(0.0, 4.0, 0.25);
    let mut progress = Progress::new(0.0, ONE);
    let failure = fly(&grid, &mut progress).expect_err("the pole is at 1 s");
    let Failure::NonFinite { time, name, value } = failure else {
        panic!("{failure}");
    };
    assert!(time >= 1.0 && name == "size" && !value.is_finite());
    let last = State {
        size: progress.state.size,
        time,
    };
    assert_eq!((progress.time, progress.state), (time, last));
    assert!(last.find(|x| !x.is_finite()).is_none());
    assert_eq!(
        failure.to_string(),
        format!("after {time} s size or its rate became infinite")
    );
}

#[test]
fn grids_that_make_no_sense_are_refused() {
    for (begin, end, dt, expected) in [
        (0.0, 1.0, 0.0, "step"),
        (0.0, 1.0, f64::NAN, "step"),
        (f64::INFINITY, 1.0, 0.1, "begin"),
        (0.0, f64::NAN, 0.1, "end"),
        (1.0, 1.0, 0.1, "end"),
        (0.0, 1e9, 1.0, "number of steps"),
        (0.0, f64::MAX, f64::MIN_POSITIVE, "number of steps"),
    ] {
        let refused = TimeGrid::new(begin, end, dt);
        assert!(
            matches!(refused, Err(Failure::Setting { name, .. }) if name == expected),
            "{refused:?}"
        );
    }
    assert!(TimeGrid::new(0.0, 1e8, 1.0).is_ok());
}

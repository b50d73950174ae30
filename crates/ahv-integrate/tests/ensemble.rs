//! Members of an ensemble are the same on any number of threads, in any order.
#![forbid(unsafe_code)]

use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use ahv_integrate::{ItoEulerMaruyama, ItoStrangSplitting, NormalStream, WienerSource};
use ahv_models::sdcom::{Input, Model, NOMINAL, Noise, State};

const MEMBERS: usize = 40;
const STEPS: u64 = 100;
const DT: f64 = 0.001;
const CHANNELS: usize = Noise::<()>::LEN;
const INPUT: Input<f64> = Input {
    phi: 0.282_090_6,
    delta_e: 0.228_647_8,
    delta_c: 0.0,
};
/// Level flight.
const START: State<f64> = State {
    velocity: 7702.0808,
    altitude: 85_000.0,
    gamma: 0.0,
    alpha: 0.026_210_5,
    pitch_rate: 0.0,
    chi_1: 0.0,
    chi_2: 0.0,
    chi_3: 0.0,
};

/// The end of a member's flight, the noise keyed by seed, member, step and channel.
fn member(member: u64) -> [[u64; State::<()>::LEN]; 2] {
    let model = Model::new(&NOMINAL);
    let mut wiener = WienerSource::<CHANNELS>::new(11, member);
    let mut streams = [0, 1, 2, 3, 4, 5].map(|channel| {
        let after_the_increments = CHANNELS as u64 + channel;
        NormalStream::new(11, member, after_the_increments)
    });
    let split = ItoStrangSplitting::<_, 3>::new(&model, &START, &INPUT, DT).expect("three states");
    let (mut x, mut y) = (START, START);
    for step in 0..STEPS {
        let dw = wiener.increments(step, DT);
        ItoEulerMaruyama::new(DT)
            .step(&model, &mut x, &INPUT, &dw)
            .expect("a second from the trim");
        let [a, b, c, d, e, f] = streams.each_mut().map(|stream| stream.normal(step));
        split
            .step_heun(&model, &mut y, &INPUT, &dw, &[[a, b, c], [d, e, f]])
            .expect("a second from the trim");
    }
    [x, y].map(|end| end.to_array().map(f64::to_bits))
}

/// All members, taken from a queue in the order `stride`, 2 `stride`, … modulo their number.
fn ensemble(threads: usize, stride: usize) -> Vec<[[u64; State::<()>::LEN]; 2]> {
    let taken = AtomicUsize::new(0);
    let work = || {
        let mut done = Vec::new();
        loop {
            let place = taken.fetch_add(1, Ordering::Relaxed);
            if place >= MEMBERS {
                return done;
            }
            let number = place * stride % MEMBERS;
            done.push((number, member(number as u64)));
        }
    };
    let mut done: Vec<_> = thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        let ended = workers
            .into_iter()
            .flat_map(|worker| worker.join().expect("no panic"));
        ended.collect()
    });
    done.sort_by_key(|&(number, _)| number);
    done.into_iter().map(|(_, ends)| ends).collect()
}

#[test]
fn neither_threads_nor_order_change_a_bit() {
    let expected = ensemble(1, 1);
    assert_eq!(expected.len(), MEMBERS);
    assert!(expected.is_sorted_by(|a, b| a != b), "members differ");
    for (threads, stride) in [(1, 7), (2, 11), (5, 1), (5, 13)] {
        assert_eq!(ensemble(threads, stride), expected, "{threads} threads");
    }
}

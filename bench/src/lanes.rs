//! The generated functions for members side by side.

use std::marker::PhantomData;
use std::time::Instant;

use ahv_bench_kernels::lanes::{
    DcomDrift, DcomDriftJacobians, LANES, Packed, Pair, Scalar, SdcomDriftDiffusion, Side,
};
use ahv_core::{Branchless, Lanes, Vector};
use ahv_models::{dcom, sdcom};

use crate::kernel::{Evaluate, PASSES};
use crate::layout;
use crate::points::Points;
use crate::subject::SUBJECTS;

/// A scalar without branches.
pub(crate) type Exact = Branchless<f64>;
/// The same for a short function.
pub(crate) type Short = Pair;

/// How they are built, for people.
pub(crate) const EXACT: &str =
    "rustc -O, thin LTO, baseline target, AVX2 or AVX-512 chosen at run time";

/// Whether the machine's registers hold a number of each member: of [`Short`], the halves would not fill one.
pub(crate) fn all_in_a_register() -> bool {
    #[cfg(target_arch = "x86_64")]
    {
        pulp::x86::V4::try_new().is_some()
    }
    #[cfg(not(target_arch = "x86_64"))]
    {
        false
    }
}

/// Evaluates at points of which each [`LANES`] lie side by side, and leaves the results of the last of them.
type Call<M, X, U, Y> = fn(&M, &[X], &[U], &mut Y);

/// A function with its points and its results in place.
struct SideBySide<M, X, U, Y> {
    call: Call<M, X, U, Y>,
    /// Appends the results of a member to numbers.
    tell: fn(&Y, usize, &mut Vec<f64>),
    model: M,
    /// States and inputs, once they are known.
    packed: Option<(Vec<X>, Vec<U>)>,
    results: Y,
    /// Where each result stands in the dense outputs, one after the other.
    positions: Vec<usize>,
    dense: usize,
}

impl<M, X: Vector<Packed>, U: Vector<Packed>, Y> SideBySide<M, X, U, Y> {
    fn pack(points: &Points) -> (Vec<X>, Vec<U>) {
        let all: Vec<_> = points.iter().collect();
        let blocks = all.chunks(LANES).map(|block| {
            // Lanes without point repeat the last one.
            let at = |lane: usize| block[lane.min(block.len() - 1)];
            let number = |i| Lanes(std::array::from_fn(|lane| at(lane).0[i]));
            let input = |i| Lanes(std::array::from_fn(|lane| at(lane).1[i]));
            (X::from_fn(number), U::from_fn(input))
        });
        blocks.unzip()
    }
}

impl<M, X: Vector<Packed>, U: Vector<Packed>, Y> Evaluate for SideBySide<M, X, U, Y> {
    fn values(&mut self, points: &Points) -> Result<Vec<Vec<f64>>, String> {
        let mut all = Vec::new();
        let (states, inputs) = Self::pack(points);
        for (x, u) in states.iter().zip(&inputs) {
            let (x, u) = (std::slice::from_ref(x), std::slice::from_ref(u));
            (self.call)(&self.model, x, u, &mut self.results);
            for lane in 0..LANES {
                let (mut numbers, mut dense) = (Vec::new(), vec![0.0; self.dense]);
                (self.tell)(&self.results, lane, &mut numbers);
                for (&position, number) in self.positions.iter().zip(numbers) {
                    dense[position] = number;
                }
                all.push(dense);
            }
        }
        all.truncate(points.len());
        Ok(all)
    }

    fn turn(&mut self, points: &Points, _: u32) -> Result<f64, String> {
        let (states, inputs) = self.packed.get_or_insert_with(|| Self::pack(points));
        let start = Instant::now();
        for _ in 0..PASSES {
            (self.call)(&self.model, states, inputs, &mut self.results);
        }
        let evaluations = PASSES as usize * LANES * states.len();
        Ok(start.elapsed().as_secs_f64() / evaluations as f64)
    }
}

macro_rules! kernel {
    ($call:ident<$scalar:ty>, $module:ident, $results:ty, $subject:expr) => {
        Box::new(SideBySide {
            call: |model, states, inputs, results| {
                pulp::Arch::new().dispatch($call::<$scalar> {
                    model,
                    states,
                    inputs,
                    results,
                    scalar: PhantomData,
                });
            },
            tell: <$results as Side>::tell,
            model: $module::Model::new(&$module::NOMINAL).map_ref(|&it| Packed::splat(it)),
            packed: None,
            results: <$results as Side>::empty(),
            positions: layout::of_product(&$subject).concat(),
            dense: $subject.dense(),
        })
    };
}

/// The kernels of all subjects, the short function with the scalar `S` and long ones with `L`.
pub(crate) fn kernels<S: Scalar, L: Scalar>() -> Vec<Box<dyn Evaluate>> {
    vec![
        kernel!(DcomDrift<S>, dcom, dcom::State<S>, SUBJECTS[0]),
        kernel!(
            DcomDriftJacobians<L>,
            dcom,
            (dcom::State<L>, [L; 48], [L; 18]),
            SUBJECTS[1]
        ),
        kernel!(
            SdcomDriftDiffusion<L>,
            sdcom,
            (sdcom::State<L>, sdcom::Diffusion<L>),
            SUBJECTS[2]
        ),
    ]
}

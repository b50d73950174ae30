//! The generated functions for [`LANES`] members side by side, as the Monte Carlo flies them.
//!
//! Numbers lie member by member. A call is a loop over members around code without branches, and `pulp` runs it with the
//! vector instructions of the machine.

use std::hint::black_box;
use std::marker::PhantomData;

use ahv_core::{Branchless, Lanes, Real, Vector as _};
use ahv_integrate::Rk4;
use ahv_models::{dcom, sdcom};

/// Members side by side.
pub const LANES: usize = 8;

/// A number of each member.
pub type Packed = Lanes<f64, LANES>;

/// What a member's results become among those of all.
pub trait Side {
    /// The results of all members.
    type Packed: Copy;

    /// Before there are any.
    fn empty() -> Self::Packed;

    /// Puts those of a turn to their places.
    fn put(self, places: &mut Self::Packed, turn: usize);

    /// Appends those of one member to `numbers`, row by row.
    fn tell(places: &Self::Packed, lane: usize, numbers: &mut Vec<f64>);
}

/// A scalar that members are computed with.
pub trait Scalar: Real + Side<Packed = Packed> {
    /// Turns of the loop over the members: as many as there are, or fewer with some in each.
    const TURNS: usize = LANES;

    /// The numbers of the members of a turn.
    fn pick(numbers: &Packed, turn: usize) -> Self;
}

impl Scalar for Branchless<f64> {
    #[inline(always)]
    fn pick(numbers: &Packed, turn: usize) -> Self {
        Self(numbers.0[turn])
    }
}

/// Two members in a turn: operations of one fill the time in which those of the other wait for each other.
///
/// That is faster for a short function. Of long ones the compiler no longer makes vector instructions.
pub type Pair = Lanes<Branchless<f64>, 2>;

impl Scalar for Pair {
    const TURNS: usize = LANES / 2;

    #[inline(always)]
    fn pick(numbers: &Packed, turn: usize) -> Self {
        Self([numbers.0[turn], numbers.0[turn + LANES / 2]].map(Branchless))
    }
}

impl Side for Pair {
    type Packed = Packed;

    fn empty() -> Packed {
        Packed::ZERO
    }

    #[inline(always)]
    fn put(self, places: &mut Packed, turn: usize) {
        let Self([one, other]) = self;
        (places.0[turn], places.0[turn + LANES / 2]) = (one.0, other.0);
    }

    fn tell(places: &Packed, lane: usize, numbers: &mut Vec<f64>) {
        numbers.push(places.0[lane]);
    }
}

impl Side for Branchless<f64> {
    type Packed = Packed;

    fn empty() -> Packed {
        Packed::ZERO
    }

    #[inline(always)]
    fn put(self, places: &mut Packed, turn: usize) {
        places.0[turn] = self.0;
    }

    fn tell(places: &Packed, lane: usize, numbers: &mut Vec<f64>) {
        numbers.push(places.0[lane]);
    }
}

impl<T: Side, const N: usize> Side for [T; N] {
    type Packed = [T::Packed; N];

    fn empty() -> Self::Packed {
        [T::empty(); N]
    }

    #[inline(always)]
    fn put(self, places: &mut Self::Packed, turn: usize) {
        for (place, value) in places.iter_mut().zip(self) {
            value.put(place, turn);
        }
    }

    fn tell(places: &Self::Packed, lane: usize, numbers: &mut Vec<f64>) {
        places.iter().for_each(|it| T::tell(it, lane, numbers));
    }
}

impl<A: Side, B: Side> Side for (A, B) {
    type Packed = (A::Packed, B::Packed);

    fn empty() -> Self::Packed {
        (A::empty(), B::empty())
    }

    #[inline(always)]
    fn put(self, places: &mut Self::Packed, turn: usize) {
        self.0.put(&mut places.0, turn);
        self.1.put(&mut places.1, turn);
    }

    fn tell(places: &Self::Packed, lane: usize, numbers: &mut Vec<f64>) {
        A::tell(&places.0, lane, numbers);
        B::tell(&places.1, lane, numbers);
    }
}

impl<A: Side, B: Side, C: Side> Side for (A, B, C) {
    type Packed = (A::Packed, B::Packed, C::Packed);

    fn empty() -> Self::Packed {
        (A::empty(), B::empty(), C::empty())
    }

    #[inline(always)]
    fn put(self, places: &mut Self::Packed, turn: usize) {
        self.0.put(&mut places.0, turn);
        self.1.put(&mut places.1, turn);
        self.2.put(&mut places.2, turn);
    }

    fn tell(places: &Self::Packed, lane: usize, numbers: &mut Vec<f64>) {
        A::tell(&places.0, lane, numbers);
        B::tell(&places.1, lane, numbers);
        C::tell(&places.2, lane, numbers);
    }
}

macro_rules! vectors {
    ($($module:ident::$vector:ident;)+) => {$(
        impl<T: Side> Side for $module::$vector<T> {
            type Packed = $module::$vector<T::Packed>;

            fn empty() -> Self::Packed {
                $module::$vector::splat(T::empty())
            }

            #[inline(always)]
            fn put(self, places: &mut Self::Packed, turn: usize) {
                places.update(self, |place, value| value.put(place, turn));
            }

            fn tell(places: &Self::Packed, lane: usize, numbers: &mut Vec<f64>) {
                let mut tell = |it: &T::Packed| T::tell(it, lane, numbers);
                places.map_ref(&mut tell);
            }
        }
    )+};
}

vectors! {
    dcom::State;
    sdcom::State;
    sdcom::Noise;
}

macro_rules! functions {
    ($($(#[$doc:meta])+ $name:ident = $module:ident::$function:ident -> $results:ty;)+) => {$(
        $(#[$doc])+
        pub struct $name<'a, R: Scalar> {
            /// The model, with parameters of its own in every member.
            pub model: &'a $module::Model<Packed>,
            /// States of eight members after eight members.
            pub states: &'a [$module::State<Packed>],
            /// Their inputs.
            pub inputs: &'a [$module::Input<Packed>],
            /// Where the results of the last eight go.
            pub results: &'a mut <$results as Side>::Packed,
            /// What they are computed with.
            pub scalar: PhantomData<R>,
        }

        impl<R: Scalar> pulp::WithSimd for $name<'_, R> {
            type Output = ();

            #[inline(always)]
            fn with_simd<V: pulp::Simd>(self, _: V) {
                // Local copies, of which the compiler knows that no store to a result changes them.
                let prepared = self.model.prepared;
                let mut results = <$results as Side>::empty();
                for (x, u) in self.states.iter().zip(self.inputs) {
                    let (x, u) = (*x, *u);
                    for turn in 0..R::TURNS {
                        let pick = |numbers: &Packed| R::pick(numbers, turn);
                        let (x, u, p) = (x.map_ref(pick), u.map_ref(pick), prepared.map_ref(pick));
                        $module::$function(&x, &u, &p).put(&mut results, turn);
                    }
                    // One place for all stays in the cache; nobody may leave out what is overwritten there.
                    black_box(&mut results);
                }
                *self.results = results;
            }
        }
    )+};
}

/// DCOM with compressed Jacobians as arrays.
mod arrays {
    use ahv_core::Real;
    pub(super) use ahv_models::dcom::*;

    #[inline(always)]
    pub(super) fn drift_and_jacobians<R: Real>(
        x: &State<R>,
        u: &Input<R>,
        p: &Prepared<R>,
    ) -> (State<R>, [R; 48], [R; 18]) {
        let (drift, by_state, by_input) = drift_and_jacobians_values(x, u, p);
        (drift, by_state.to_array(), by_input.to_array())
    }
}

functions! {
    /// Drift of DCOM.
    DcomDrift = dcom::drift -> dcom::State<R>;
    /// Drift of DCOM, and the entries of both Jacobians that are not 0 by structure.
    DcomDriftJacobians = arrays::drift_and_jacobians -> (dcom::State<R>, [R; 48], [R; 18]);
    /// Drift and diffusion of SDCOM.
    SdcomDriftDiffusion = sdcom::drift_and_diffusion -> (sdcom::State<R>, sdcom::Diffusion<R>);
}

/// Flights of DCOM by [`Rk4`] at held inputs.
pub struct DcomRk4<'a, R: Scalar> {
    /// The model, with parameters of its own in every member.
    pub model: &'a dcom::Model<Packed>,
    /// Where the members are, and where they get to.
    pub state: &'a mut dcom::State<Packed>,
    /// Their inputs.
    pub input: &'a dcom::Input<Packed>,
    /// Step size, in s.
    pub dt: f64,
    /// Number of steps.
    pub steps: usize,
    /// What they are computed with.
    pub scalar: PhantomData<R>,
}

impl<R: Scalar> pulp::WithSimd for DcomRk4<'_, R> {
    type Output = ();

    #[inline(always)]
    fn with_simd<V: pulp::Simd>(self, _: V) {
        let dt = self.dt;
        // Known to hold from here on, it costs nothing in the loop.
        if !(dt > 0.0 && dt.is_finite()) {
            return;
        }
        let stepper = Rk4::new(dt);
        let (model, mut x, u) = (*self.model, *self.state, *self.input);
        let mut next = x;
        for _ in 0..self.steps {
            for turn in 0..R::TURNS {
                let pick = |numbers: &Packed| R::pick(numbers, turn);
                let mut member = x.map_ref(pick);
                // A scalar without branches has no failure.
                let _ = stepper.step(&model.map_ref(pick), &mut member, &u.map_ref(pick));
                member.put(&mut next, turn);
            }
            x = next;
        }
        *self.state = x;
    }
}

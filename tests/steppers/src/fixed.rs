//! Deterministic steppers with a fixed step.

use ahv_core::DifferentiableModel;
use ahv_integrate::{
    DormandPrince54, DormandPrince853, Euler, Exponential, Fixed, FlexibleMode, Heun, Progress,
    Rk4, Rodas4, TimeGrid, Tsit5,
};
use core::hint::black_box;

use crate::{Place, Visitor, step_size};

/// Every one of them; the input is held.
pub(crate) fn all<M: DifferentiableModel>(at: &Place<M>, visitor: &mut dyn Visitor<M::Scalar>) {
    let (m, u, dt) = (&at.model, &at.u, step_size());
    at.visit(visitor, "Euler", "", |x, _| {
        Euler::new(dt).step(m, x, u).is_ok()
    });
    at.visit(visitor, "Heun", "", |x, _| {
        Heun::new(dt).step(m, x, u).is_ok()
    });
    at.visit(visitor, "Rk4", "", |x, _| {
        Rk4::new(dt).step(m, x, u).is_ok()
    });
    at.visit(visitor, "Fixed<DormandPrince54>", "", |x, _| {
        Fixed::new(DormandPrince54, dt).step(m, x, u).is_ok()
    });
    at.visit(visitor, "Fixed<Tsit5>", "", |x, _| {
        Fixed::new(Tsit5, dt).step(m, x, u).is_ok()
    });
    at.visit(visitor, "Fixed<DormandPrince853>", "", |x, _| {
        Fixed::new(DormandPrince853, dt).step(m, x, u).is_ok()
    });
    at.visit(visitor, "Fixed<Rodas4>", "", |x, _| {
        Fixed::new(Rodas4, dt).step(m, x, u).is_ok()
    });
    at.visit(visitor, "TimeGrid", "", |x, _| {
        let mut progress = Progress::new(black_box(0.0), *x);
        let Ok(grid) = TimeGrid::new(progress.time, black_box(0.01), dt) else {
            return false;
        };
        let mut stepped = Ok(true);
        while stepped == Ok(true) {
            stepped = grid.step(&mut progress, |x, _, dt| Rk4::new(dt).step(m, x, u));
        }
        *x = progress.state;
        stepped.is_ok()
    });
    let mode = |position, rate, omega| {
        let (omega, zeta) = (black_box(omega), black_box(0.7));
        FlexibleMode::new::<M>(black_box(position), black_box(rate), omega, zeta)
    };
    if let (Some(first), Some(second)) = (
        mode("eta_1", "eta_dot_1", 19.7437),
        mode("eta_2", "eta_dot_2", 47.7851),
    ) {
        let exponential = Exponential::new(dt, [first, second]);
        at.visit(visitor, "Exponential", "", |x, _| {
            exponential.step(m, x, u).is_ok()
        });
    }
}

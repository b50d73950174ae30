//! Kernels of a service that loops over the points itself.

use std::cell::RefCell;
use std::rc::Rc;

use crate::arrays::{self, Turn};
use crate::kernel::{Evaluate, PASSES};
use crate::points::Points;
use crate::service::Service;
use crate::subject::Subject;

/// A function in a program of its own, which has the points.
pub(crate) struct Interpreted {
    service: Rc<RefCell<Service>>,
    job: &'static str,
    dense: usize,
    first: f64,
}

impl Interpreted {
    /// The function of `subject` at the service.
    pub(crate) fn new(service: &Rc<RefCell<Service>>, subject: &Subject) -> Self {
        let sizes = subject.shapes.iter().map(|(rows, columns)| rows * columns);
        Self {
            service: Rc::clone(service),
            job: subject.symbol,
            dense: sizes.sum(),
            first: 0.0,
        }
    }
}

impl Evaluate for Interpreted {
    fn values(&mut self, _: &Points) -> Result<Vec<Vec<f64>>, String> {
        let turn = Turn {
            values: true,
            ..Turn::of(0)
        };
        let answer = arrays::ask(&self.service, self.job, turn)?;
        self.first = answer.first;
        Ok(answer
            .values
            .chunks(self.dense)
            .map(<[f64]>::to_vec)
            .collect())
    }

    fn turn(&mut self, points: &Points, _: u32) -> Result<f64, String> {
        let turn = Turn {
            // What others have put into the caches since the last turn does not count.
            warm_up: 1,
            repeats: PASSES,
            ..Turn::of(0)
        };
        Ok(arrays::ask(&self.service, self.job, turn)?.seconds / points.len() as f64)
    }

    fn first(&self) -> f64 {
        self.first
    }
}

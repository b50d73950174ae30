//! The picture of `ahv reduce`: a row a mode.

use ahv_analysis::statistics::Estimate;
use ahv_plot::{Axis, Colour, Figure, Layer, Mark, Panel, PlotError};

use super::Subject;
use crate::ensemble::Moments;

/// Points of a curve.
const POINTS: u32 = 300;
/// Lags that are shown, in units of 1/(ζω).
const LAGS: f64 = 5.0;
/// Frequencies that are shown, in units of ω.
const FREQUENCIES: (f64, f64) = (0.01, 100.0);
const ETA: (&str, Colour) = ("mode, η", Colour::Blue);
const CHI: (&str, Colour) = ("coloured noise, χ", Colour::Vermillion);

/// Standard deviations over time, autocorrelations and spectra of the modes.
pub(super) fn draw(subjects: &[Subject]) -> Result<String, PlotError> {
    let panels = (1..).zip(subjects).flat_map(|(number, subject)| {
        [
            deviations(number, subject),
            autocorrelations(number, subject),
            spectra(number, subject),
        ]
    });
    Figure::new("", 3, panels.collect()).svg()
}

fn deviations(number: usize, subject: &Subject) -> Panel {
    let end = subject.times.last().copied().unwrap_or_default();
    let times = (0..=POINTS).map(|index| end * f64::from(index) / f64::from(POINTS));
    let reduced = &subject.reduced;
    let eta = times
        .clone()
        .map(|time| (time, reduced.eta_variance_at(time).sqrt()));
    let chi = times.map(|time| (time, reduced.chi_variance_at(time).sqrt()));
    let band = |moments: &Moments| {
        let edges = |(&time, Estimate { low, high, .. })| (time, low, high);
        subject
            .times
            .iter()
            .zip(subject.sampled(moments))
            .map(edges)
            .collect()
    };
    Panel {
        title: format!("mode {number}: standard deviation from rest"),
        x: Axis::linear("time [s]"),
        y: Axis::linear("D [(ft·slug)^½]"),
        layers: vec![
            Layer::new("η sampled, 95 %", ETA.1, Mark::Band(band(&subject.eta))),
            Layer::new("χ sampled, 95 %", CHI.1, Mark::Band(band(&subject.chi))),
            Layer::new(ETA.0, ETA.1, Mark::Line(eta.collect())),
            Layer::new(CHI.0, CHI.1, Mark::Line(chi.collect())).dashed(),
        ],
    }
}

fn autocorrelations(number: usize, subject: &Subject) -> Panel {
    let reduced = &subject.reduced;
    let end = LAGS / (reduced.mode.zeta * reduced.mode.omega);
    let lags = (0..=POINTS).map(|index| end * f64::from(index) / f64::from(POINTS));
    let eta = lags
        .clone()
        .map(|lag| (lag, reduced.eta_autocorrelation(lag)));
    let chi = lags.map(|lag| (lag, reduced.chi_autocorrelation(lag)));
    Panel {
        title: format!("mode {number}: autocorrelation"),
        x: Axis::linear("lag [s]"),
        y: Axis::linear("R [ft·slug]"),
        layers: vec![
            Layer::new(ETA.0, ETA.1, Mark::Line(eta.collect())),
            Layer::new(CHI.0, CHI.1, Mark::Line(chi.collect())).dashed(),
        ],
    }
}

fn spectra(number: usize, subject: &Subject) -> Panel {
    let reduced = &subject.reduced;
    let (low, high) = FREQUENCIES;
    let ratio = (high / low).powf(1.0 / f64::from(POINTS));
    let frequencies =
        (0..=POINTS).map(|index| reduced.mode.omega * low * ratio.powf(f64::from(index)));
    let eta = frequencies.clone().map(|at| (at, reduced.eta_spectrum(at)));
    let chi = frequencies.map(|at| (at, reduced.chi_spectrum(at)));
    Panel {
        title: format!("mode {number}: spectrum"),
        x: Axis::log("frequency [rad/s]"),
        y: Axis::log("S [ft·slug·s]"),
        layers: vec![
            Layer::new(ETA.0, ETA.1, Mark::Line(eta.collect())),
            Layer::new(CHI.0, CHI.1, Mark::Line(chi.collect())).dashed(),
        ],
    }
}

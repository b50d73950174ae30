//! Which pole belongs to which mode.

use std::fmt;

use nalgebra::{Complex, DMatrix};

use super::Pole;

/// A mode of a flexible vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Angle of attack against pitch rate.
    ShortPeriod,
    /// Velocity, flight path and altitude against each other; the pair of the three slow poles.
    Phugoid,
    /// The third slow pole, for the air thins with altitude.
    Height,
    /// A flexible mode, by number.
    Flexible(u32),
    /// The coloured noise that stands for a flexible mode, by number.
    ColouredNoise(u32),
    /// The gust.
    Gust,
}

impl fmt::Display for Mode {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ShortPeriod => formatter.write_str("short period"),
            Self::Phugoid => formatter.write_str("phugoid"),
            Self::Height => formatter.write_str("height"),
            Self::Flexible(number) => write!(formatter, "flexible {number}"),
            Self::ColouredNoise(number) => write!(formatter, "coloured noise {number}"),
            Self::Gust => formatter.write_str("gust"),
        }
    }
}

/// The mode that a state belongs to; the three slow states all count as of the phugoid.
fn mode_of(state: &str) -> Option<Mode> {
    let number = |prefix| state.strip_prefix(prefix)?.parse().ok();
    match state {
        "alpha" | "pitch_rate" => Some(Mode::ShortPeriod),
        "velocity" | "gamma" | "altitude" => Some(Mode::Phugoid),
        "alpha_gust" => Some(Mode::Gust),
        _ => number("eta_dot_")
            .or_else(|| number("eta_"))
            .map(Mode::Flexible)
            .or_else(|| number("chi_").map(Mode::ColouredNoise)),
    }
}

/// A mode with its states, and the poles that it has not been given yet.
struct Group {
    mode: Mode,
    states: Vec<usize>,
    free: usize,
}

/// The poles with their modes.
///
/// A mode has as many poles as states. Poles, pairs together, go to the mode whose states participate most, the
/// clearest cases first.
pub(super) fn named(
    states: &[&str],
    values: &[Complex<f64>],
    participation: Option<&DMatrix<f64>>,
) -> Vec<Pole> {
    let mut poles: Vec<Pole> = values
        .iter()
        .map(|&value| Pole {
            value,
            mode: None,
            participation: 0.0,
        })
        .collect();
    let Some(participation) = participation else {
        return poles;
    };
    let mut groups = groups(states);
    let mut cases = Vec::new();
    for (pole, value) in values
        .iter()
        .enumerate()
        .filter(|(_, value)| value.im >= 0.0)
    {
        // The upper root of a pair stands before the lower one.
        let size = if value.im > 0.0 { 2 } else { 1 };
        for (group, Group { states, .. }) in groups.iter().enumerate() {
            let share: f64 = states.iter().map(|&it| participation[(it, pole)]).sum();
            cases.push((share, pole, size, group));
        }
    }
    cases.sort_by(|a, b| b.0.total_cmp(&a.0));
    for (share, pole, size, group) in cases {
        let Some(group) = groups.get_mut(group).filter(|group| group.free >= size) else {
            continue;
        };
        let roots = poles.iter_mut().skip(pole).take(size);
        let mut untold: Vec<_> = roots.filter(|root| root.mode.is_none()).collect();
        if untold.len() < size {
            continue;
        }
        for root in &mut untold {
            root.mode = Some(group.mode);
            root.participation = share;
        }
        group.free -= size;
    }
    tell_height(states, &mut poles);
    poles
}

fn groups(states: &[&str]) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for (state, mode) in states.iter().enumerate() {
        let Some(mode) = mode_of(mode) else { continue };
        match groups.iter_mut().find(|group| group.mode == mode) {
            Some(group) => {
                group.states.push(state);
                group.free += 1;
            }
            None => groups.push(Group {
                mode,
                states: vec![state],
                free: 1,
            }),
        }
    }
    groups
}

/// Of the three slow poles the real one beside a pair is the height mode; of three real ones that nearest to 0, for the air
/// thins slowly with altitude.
fn tell_height(states: &[&str], poles: &mut [Pole]) {
    if !states.contains(&"altitude") {
        return;
    }
    let real = poles
        .iter_mut()
        .filter(|pole| pole.mode == Some(Mode::Phugoid) && pole.value.im == 0.0);
    let height = real.min_by(|a, b| a.value.re.abs().total_cmp(&b.value.re.abs()));
    if let Some(pole) = height {
        pole.mode = Some(Mode::Height);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// With some parameters the phugoid is a slow divergence and a slow decay, in which the altitude participates more than
    /// in the height mode.
    #[test]
    fn the_height_mode_is_the_slowest_of_three_real_poles() {
        let values = [7.1e-5, 0.013_75, -0.014_37].map(Complex::from);
        let shares = [0.2, 0.3, 0.3, 0.3, 0.1, 0.1, 0.5, 0.6, 0.6];
        let participation = DMatrix::from_row_slice(3, 3, &shares);
        let poles = named(
            &["velocity", "gamma", "altitude"],
            &values,
            Some(&participation),
        );
        let modes: Vec<_> = poles.iter().map(|pole| pole.mode).collect();
        let [height, phugoid] = [Some(Mode::Height), Some(Mode::Phugoid)];
        assert_eq!(modes, [height, phugoid, phugoid]);
    }
}

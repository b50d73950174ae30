//! Which pole belongs to which mode.

use ahv_core::ModeOfMotion;

use super::{Found, Pole};

/// A mode with its states, and the poles that it has not been given yet.
struct Group {
    mode: ModeOfMotion,
    states: Vec<usize>,
    free: usize,
}

/// The poles, found with the participation of each state, with their modes.
///
/// A mode has as many poles as states. Poles, pairs together, go to the mode whose states participate most, the
/// clearest cases first.
pub(super) fn named(modes: &[ModeOfMotion], states: &[&str], found: &[Found]) -> Vec<Pole> {
    let mut poles: Vec<Pole> = found
        .iter()
        .map(|&(value, _)| Pole {
            value,
            mode: None,
            participation: 0.0,
        })
        .collect();
    let mut groups = groups(modes, states);
    let mut cases = Vec::new();
    for (pole, (value, participation)) in found.iter().enumerate() {
        // The upper root of a pair stands before the lower one.
        let size = match value.im {
            im if im > 0.0 => 2,
            im if im < 0.0 => continue,
            _ => 1,
        };
        for (group, Group { states, .. }) in groups.iter().enumerate() {
            let share: f64 = states.iter().map(|&it| participation[it]).sum();
            if share > 0.0 {
                cases.push((share, pole, size, group));
            }
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
            root.mode = Some(group.mode.name);
            root.participation = share;
        }
        group.free -= size;
    }
    for mode in modes {
        tell_slowest(mode, &mut poles);
    }
    poles
}

/// The modes whose states are among these.
fn groups(modes: &[ModeOfMotion], states: &[&str]) -> Vec<Group> {
    let index = |name: &&str| states.iter().position(|state| state == name);
    let groups = modes.iter().map(|&mode| {
        let states: Vec<usize> = mode.states.iter().filter_map(index).collect();
        Group {
            mode,
            free: states.len(),
            states,
        }
    });
    groups.collect()
}

/// Of an odd number of real poles the slowest may have a name of its own: of three slow poles of a vehicle the real one
/// beside a pair, or of three real ones that nearest to 0, is the height mode, for the air thins slowly with altitude.
fn tell_slowest(mode: &ModeOfMotion, poles: &mut [Pole]) {
    let Some(name) = mode.slowest else { return };
    let real = poles
        .iter_mut()
        .filter(|pole| pole.mode == Some(mode.name) && pole.value.im == 0.0);
    let real: Vec<&mut Pole> = real.collect();
    if real.len().is_multiple_of(2) {
        return;
    }
    let slowest = real
        .into_iter()
        .min_by(|a, b| a.value.re.abs().total_cmp(&b.value.re.abs()));
    if let Some(pole) = slowest {
        pole.mode = Some(name);
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Complex, DVector};

    use super::*;

    /// With some parameters the phugoid is a slow divergence and a slow decay, in which the altitude participates more than
    /// in the height mode.
    #[test]
    fn the_height_mode_is_the_slowest_of_three_real_poles() {
        let values = [7.1e-5, 0.013_75, -0.014_37].map(Complex::from);
        let shares = [[0.2, 0.3, 0.5], [0.3, 0.1, 0.6], [0.3, 0.1, 0.6]];
        let shares = shares.map(|of| DVector::from_row_slice(&of));
        let found: Vec<_> = values.into_iter().zip(shares).collect();
        let phugoid = ModeOfMotion::new(
            "phugoid",
            &["velocity", "altitude", "gamma"],
            Some("height"),
        );
        let poles = named(&[phugoid], &["velocity", "gamma", "altitude"], &found);
        let modes: Vec<_> = poles.iter().map(|pole| pole.mode).collect();
        let [height, phugoid] = [Some("height"), Some("phugoid")];
        assert_eq!(modes, [height, phugoid, phugoid]);
    }
}

//! Roots of two systems side by side.

use ahv_analysis::disperse::assignment;

use super::printed::Root;

/// Two roots correspond only if they are not farther apart than this share of the larger.
pub const LIMIT: f64 = 0.25;
/// Roots below this frequency, in rad/s, are those of the slow modes.
pub const SLOW: f64 = 0.1;
/// Size below which a root is 0: what QR and QZ leave of it, in rad/s.
pub const NOTHING: f64 = 1e-7;
/// Cost of a root without counterpart: more than all distances within the limit together.
const ALONE: f64 = 100.0;

/// What a root belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// The rigid body.
    Rigid,
    /// A flexible mode.
    Flexible,
    /// Noise that is shaped: a pole of coloured noise, or the zero that cancels it.
    Noise,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Self; 3] = [Self::Rigid, Self::Flexible, Self::Noise];

    /// The name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rigid => "rigid",
            Self::Flexible => "flexible",
            Self::Noise => "noise",
        }
    }

    /// The kind of a root of which the place in the plane alone is known, as of those in Table 3: pairs above [`SLOW`] are
    /// flexible.
    pub fn of_place(root: Root) -> Self {
        if root[1] != 0.0 && size(root) > SLOW {
            Self::Flexible
        } else {
            Self::Rigid
        }
    }
}

/// Roots of a kind that correspond, or one without counterpart.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Pair {
    /// Their kind.
    pub kind: Kind,
    /// The printed root.
    pub printed: Option<Root>,
    /// The computed one.
    pub ours: Option<Root>,
}

/// |λ|.
pub fn size([re, im]: Root) -> f64 {
    re.hypot(im)
}

/// Distance of two roots as a share of the larger; 0 where both are 0.
pub fn relative_distance(a: Root, b: Root) -> f64 {
    let larger = size(a).max(size(b));
    if larger < NOTHING {
        0.0
    } else {
        size([a[0] - b[0], a[1] - b[1]]) / larger
    }
}

/// Printed and computed roots, each with its kind, side by side; of a conjugate pair the upper one counts.
///
/// Within each kind as many correspond as can within [`LIMIT`], and among such assignments the sum of their relative
/// distances is least. Printed roots come first, in their order.
pub fn pairs(printed: &[(Root, Kind)], ours: &[(Root, Kind)]) -> Vec<Pair> {
    let mut pairs = Vec::new();
    for kind in Kind::ALL {
        let of_kind = |roots: &[(Root, Kind)]| -> Vec<Root> {
            let roots = roots
                .iter()
                .filter(|&&(root, of)| of == kind && root[1] >= 0.0);
            roots.map(|&(root, _)| root).collect()
        };
        let (printed, ours) = (of_kind(printed), of_kind(ours));
        let near = |row: usize, column: usize| {
            let distance = relative_distance(*printed.get(row)?, *ours.get(column)?);
            (distance <= LIMIT).then_some(distance)
        };
        let columns = assignment(printed.len().max(ours.len()), |row, column| {
            near(row, column).unwrap_or(ALONE)
        });
        let mut alone = Vec::new();
        for (row, column) in columns.into_iter().enumerate() {
            let (printed, ours) = (printed.get(row).copied(), ours.get(column).copied());
            let pair = |printed, ours| Pair {
                kind,
                printed,
                ours,
            };
            if near(row, column).is_some() {
                pairs.push(pair(printed, ours));
                continue;
            }
            if printed.is_some() {
                pairs.push(pair(printed, None));
            }
            if ours.is_some() {
                alone.push(pair(None, ours));
            }
        }
        pairs.extend(alone);
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::{Kind, Pair, pairs};

    #[test]
    fn roots_correspond_within_their_kind_and_the_limit() {
        use Kind::{Flexible, Noise, Rigid};
        let printed = [
            ([-0.54, 19.6], Flexible),
            ([-0.35, 16.2], Flexible),
            ([0.0, 0.0], Rigid),
            ([6.2e-4, 0.001], Rigid),
            ([-9.83, 0.0], Rigid),
        ];
        let ours = [
            ([-9.9, 0.0], Noise),
            ([1e-9, 0.0], Rigid),
            ([5e-4, 0.037], Rigid),
            ([5e-4, -0.037], Rigid),
            ([-0.4, 18.9], Flexible),
            ([-0.7, 24.0], Flexible),
        ];
        let pair = |kind, printed, ours| Pair {
            kind,
            printed,
            ours,
        };
        let expected = [
            pair(Rigid, Some([0.0, 0.0]), Some([1e-9, 0.0])),
            pair(Rigid, Some([6.2e-4, 0.001]), None),
            pair(Rigid, Some([-9.83, 0.0]), None),
            pair(Rigid, None, Some([5e-4, 0.037])),
            // The nearest, 18.9 to 19.6, would leave 16.2 and 24.0 without counterpart.
            pair(Flexible, Some([-0.54, 19.6]), Some([-0.7, 24.0])),
            pair(Flexible, Some([-0.35, 16.2]), Some([-0.4, 18.9])),
            pair(Noise, None, Some([-9.9, 0.0])),
        ];
        assert_eq!(pairs(&printed, &ours), expected);
    }
}

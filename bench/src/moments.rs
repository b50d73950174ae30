//! Means and standard deviations of ensembles, and whether two samples can have the same ones.

use crate::race::Finish;

/// Greatest difference of two samples in standard errors: one of hundreds of comparisons passes it in a million runs.
const MOST_ERRORS: f64 = 6.5;

/// Means of the columns, then their standard deviations.
pub(crate) fn of_members<const N: usize>(members: &[[f64; N]]) -> Vec<f64> {
    let count = members.len() as f64;
    let column = |i: usize| members.iter().map(move |it| it[i]);
    let means: Vec<f64> = (0..N).map(|i| column(i).sum::<f64>() / count).collect();
    let deviation = |(i, mean): (usize, &f64)| {
        let squares: f64 = column(i).map(|value| (value - mean).powi(2)).sum();
        (squares / (count - 1.0)).sqrt()
    };
    let deviations: Vec<f64> = means.iter().enumerate().map(deviation).collect();
    [means, deviations].concat()
}

/// The same from sums and sums of squares of values whose means are near 0.
pub(crate) fn of_sums(sums: &[[f64; 2]], count: f64) -> Vec<f64> {
    let means = sums.iter().map(|[sum, _]| sum / count);
    let deviation = |&[sum, squares]: &[f64; 2]| {
        let mean = sum / count;
        ((squares - count * mean * mean) / (count - 1.0)).sqrt()
    };
    means.chain(sums.iter().map(deviation)).collect()
}

/// Compares the moments of each runner, over all its turns of `members`, with those of the first.
///
/// Gives the greatest difference in standard errors, as if the values were normal.
///
/// # Errors
/// Moments that chance does not explain.
pub(crate) fn check(group: &str, finishes: &[Finish], members: f64) -> Result<f64, String> {
    let pooled: Vec<_> = finishes
        .iter()
        .map(|it| pool(&it.values, members))
        .collect();
    let Some((reference, others)) = pooled.split_first() else {
        return Ok(0.0);
    };
    let mut greatest = 0.0_f64;
    for (sample, finish) in others.iter().zip(&finishes[1..]) {
        let total = members * finish.values.len() as f64;
        for (&(mean, deviation), &(other_mean, other)) in sample.iter().zip(reference) {
            let of_means = (mean - other_mean).abs() / (other * (2.0 / total).sqrt());
            let of_deviations = (deviation / other - 1.0).abs() * total.sqrt();
            for errors in [of_means, of_deviations] {
                // Written so that NaN fails.
                if !errors.le(&MOST_ERRORS) {
                    let candidate = finish.candidate;
                    return Err(format!(
                        "error: {group}: {candidate} has mean {mean:e} and deviation {deviation:e}, the reference has \
                         {other_mean:e} and {other:e}: {errors:.1} standard errors"
                    ));
                }
                greatest = greatest.max(errors);
            }
        }
    }
    Ok(greatest)
}

/// Mean and standard deviation of each value over all turns.
fn pool(turns: &[Vec<f64>], members: f64) -> Vec<(f64, f64)> {
    let count = turns.len() as f64;
    let half = turns.first().map_or(0, Vec::len) / 2;
    let of = |i: usize| {
        let mean = turns.iter().map(|turn| turn[i]).sum::<f64>() / count;
        let within = turns
            .iter()
            .map(|turn| (members - 1.0) * turn[half + i].powi(2));
        let between = turns.iter().map(|turn| members * (turn[i] - mean).powi(2));
        let squares = within.sum::<f64>() + between.sum::<f64>();
        (mean, (squares / (members * count - 1.0)).sqrt())
    };
    (0..half).map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::{check, of_members, of_sums, pool};
    use crate::race::Finish;
    use crate::rounds::Spread;

    const VALUES: [[f64; 1]; 6] = [[1.0], [4.0], [-2.0], [0.5], [3.0], [-1.5]];

    #[test]
    fn turns_are_pooled_as_if_they_were_one() {
        let whole = of_members(&VALUES);
        let turns = [of_members(&VALUES[..3]), of_members(&VALUES[3..])];
        let pooled = pool(&turns, 3.0)[0];
        assert!((pooled.0 - whole[0]).abs() < 1e-15, "{pooled:?} {whole:?}");
        assert!((pooled.1 - whole[1]).abs() < 1e-15, "{pooled:?} {whole:?}");
    }

    #[test]
    fn sums_hold_the_moments() {
        let sum = VALUES.iter().map(|it| it[0]).sum();
        let squares = VALUES.iter().map(|it| it[0] * it[0]).sum();
        let (direct, summed) = (of_members(&VALUES), of_sums(&[[sum, squares]], 6.0));
        assert!(
            (direct[1] - summed[1]).abs() < 1e-15,
            "{direct:?} {summed:?}"
        );
    }

    fn finish(mean: f64, deviation: f64) -> Finish {
        Finish {
            candidate: "one",
            how: "",
            threads: 1,
            seconds: Spread::of(vec![1.0]),
            ratio: Spread::of(vec![1.0]),
            first: 0.0,
            values: vec![vec![mean, deviation]; 4],
        }
    }

    #[test]
    fn what_chance_does_not_explain_is_refused() {
        // Of 10 000 values, the error of the mean is 0.014, and that of the deviation 1 %.
        let reference = || finish(5.0, 1.0);
        let against = |other: Finish| check("test", &[reference(), other], 2500.0);
        assert!(against(finish(5.05, 1.03)).is_ok_and(|it| (3.0..3.6).contains(&it)));
        assert!(against(finish(5.1, 1.0)).is_err());
        assert!(against(finish(5.0, 1.07)).is_err());
        assert!(against(finish(f64::NAN, 1.0)).is_err());
    }
}

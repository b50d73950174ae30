//! Each sentence, with facts for and against it.

use ahv_analysis::statistics::Estimate;
use ahv_core::{Provenance, Status};

use super::*;
use crate::reduce::{Comparison, Peak, Property, StdErrors};
use crate::reproduce::Size;
use crate::reproduce::p_value::{PValue, Verdict};

/// Checks a finding for facts that agree, and one for facts that do not, each with words it must have.
fn both(pair: [Finding; 2], words: [&str; 2]) {
    let [yes, no] = &pair;
    assert!(yes.agrees && !no.agrees);
    for (finding, words) in pair.iter().zip(words) {
        let text = finding.sentence.text();
        assert!(text.contains(words), "\"{words}\" is not in: {text}");
    }
    assert!(!no.sentence.text().contains(words[0]), "{}", no.sentence);
}

const fn estimate(value: f64) -> Estimate {
    Estimate {
        value,
        low: 0.9 * value,
        high: 1.1 * value,
    }
}

#[test]
fn table_1() {
    use Verdict::{Inside, Outside, Undecided};
    both(
        [
            deviations(&[1.05, 0.9], &[Inside, Undecided]),
            deviations(&[1.3, 0.9], &[Inside, Outside]),
        ],
        [
            "within 10.00 % of the printed values; 1 inside and 1 undecided.",
            "within 30.00 % of the printed values; 1 inside and 1 outside.",
        ],
    );
    both(
        [
            white(100.0, &[1.0, 1.2], &[Inside, Inside]),
            white(100.0, &[6.1, 10.2], &[Outside, Outside]),
        ],
        [
            "2 inside; ours are 1.0 to 1.2 times",
            "2 outside; ours are 6.1 to 10.2 times",
        ],
    );
    both(
        [
            means(1000, &[Inside], None),
            means(1000, &[Outside], Some(("held", 4, 6))),
        ],
        [
            "with 1000 runs: 1 inside.",
            "1 outside. Most entries (4 of 6) are inside with this reading: held.",
        ],
    );
    let sample: Vec<f64> = (0..1000).map(f64::from).collect();
    let (inside, outside) = (PValue::new(&sample, 500.0), PValue::new(&sample, -1.0));
    let facts = |exact, common| Entry {
        white_ratio: 9.96,
        exact,
        held: &const { estimate(1.0) },
        common: (common, &outside),
        fewer: (400, &const { estimate(3.0) }, &inside),
    };
    let (small, large) = (estimate(0.5), estimate(2.0));
    let [first, second] = [
        entry(&facts(None, &small)),
        entry(&facts(Some([0.1, 0.2]), &large)),
    ];
    assert!(
        first
            .text()
            .starts_with("White noise gives 10.0 times the printed value. With one")
    );
    assert!(
        first.text().contains("smaller (p 0.000")
            && first.text().contains("outside); with 400 runs 3.000")
    );
    assert!(
        second
            .text()
            .contains("give 0.1000 at the samples and 0.2000 between them. With")
    );
    assert!(second.text().contains(", larger (p"));
    assert!(
        method(&Size::PAPER)
            .text()
            .contains("over 1000 to 16000 experiments")
    );
    assert!(
        readings(100.0, 0.01)
            .text()
            .contains("whose intensity is 100²·0.01")
    );
    assert!(
        subject(&Size::PAPER)
            .text()
            .contains("Steps of 0.01 s over 10.00 s, seed 1")
    );
}

#[test]
fn figures_3_to_5() {
    both(
        [
            normality(&[0.01, -0.03], 10_000, 10.0),
            normality(&[0.01, 0.3], 10_000, 10.0),
        ],
        [
            "0.01000 and -0.03000, all within",
            "0.01000 and 0.3000, not all within",
        ],
    );
    let [alike, apart] = <[Finding; 2]>::try_from(distributions(&[(false, 0.98), (true, 0.5)], 10))
        .unwrap_or_else(|_| panic!("one of each"));
    both(
        [alike, apart],
        [
            "do not distinguish the distributions of η and of χ of (23) in mode 1 (0.9800 of the variance)",
            "10 runs distinguish the distributions of η and of χ of (23) in mode 2 (0.5000 of the variance)",
        ],
    );
    assert_eq!(distributions(&[(true, 0.5)], 10).len(), 1);
    both(
        [follows(&[0.07, 0.03]), follows(&[0.07, 0.4])],
        ["follows η within", "does not follow η within"],
    );
    assert!(
        forced(10, &[0.5, 0.1])
            .text()
            .contains("makes 50.00 % and 10.00 % of the mean square error")
    );
    assert!(
        snapshot(100.0, 10.0, 10)
            .text()
            .contains("over 10 runs under white noise of intensity 100²")
    );
}

#[test]
fn reductions() {
    let comparison = |kept: [bool; 3]| {
        let properties = [
            Property::DecayRate,
            Property::Variance,
            Property::SpectrumAtZero,
        ];
        let mut kept = kept.into_iter();
        properties.map(|property| {
            let kept = kept.next().unwrap_or(true);
            Comparison {
                property,
                ratio: if kept { 1.0 } else { 0.5 },
                kept,
            }
        })
    };
    let text = kept(
        "printed",
        &[comparison([true; 3]), comparison([false, true, false])],
    );
    assert_eq!(
        text.text(),
        "printed: in mode 1 it keeps decay rate, variance and spectrum at zero frequency; gives up none of the three. In mode 2 it \
         keeps variance; gives up decay rate (0.5000 of the mode's) and spectrum at zero frequency (0.5000 of the mode's)."
    );
    let peak = |value, chi_leads| Peak {
        value,
        time: Some(0.01),
        chi_leads,
    };
    let rise = StdErrors {
        greatest: peak(0.3, true),
        rise: peak(0.3, true),
    };
    let late = StdErrors {
        greatest: Peak {
            time: None,
            ..peak(0.3, false)
        },
        rise: peak(0.1, true),
    };
    let text = differ(&[rise, late]);
    assert!(text.text().contains("in mode 1 they differ by 0.300000 at most, at 0.0100 s, where chi has the larger, in the rise from rest"), "{text}");
    assert!(
        text.text().contains(
            "in the long run, where eta has the larger; in the rise from rest by 0.100000"
        ),
        "{text}"
    );
    let text = least_errors(&["a", "b"], &[vec![0.1, 0.2], vec![0.3, 0.2]]);
    assert!(
        text.text()
            .ends_with("is least with a in mode 1 and b in mode 2."),
        "{text}"
    );
    both(
        [
            variances(&[0.99, 1.0], &["printed"]),
            variances(&[0.98, 0.5], &["variance", "moment"]),
        ],
        [
            "0.9900 and 1.000 of the variances",
            "0.9800 and 0.5000 of the variances of the modes of (36); reductions that keep all of them: variance and moment",
        ],
    );
}

#[test]
fn trims_and_roots() {
    both(
        [nearest_trim(0.01, "a"), nearest_trim(0.1, "a")],
        ["2: a model with", "no model with"],
    );
    both(
        [printed_form("a", 0.01), printed_form("a", 1.1)],
        [
            "1.000 % of the largest magnitude of its row in the exact form, less",
            "110.0 % of the largest magnitude of its row in the exact form, not less",
        ],
    );
    let origin = |source, status| Provenance::new(source, status, 0.4);
    let published = origin("parker2007", Status::Published);
    let place = [7702.08, 85_000.0];
    let text = trims(place, &[("flat", 0.0937)], published);
    assert!(
        text.text().contains("trims 9.370 % (flat Earth) away")
            && text.text().contains("is published")
    );
    let text = trims(place, &[], origin("own", Status::Derived));
    assert!(text.text().contains(
        "was not available: its rows are those of a table of this project (source own, derived)"
    ));
    both(
        [
            counterparts("com", "s", 2, 2),
            counterparts("com", "s", 1, 2),
        ],
        ["COM, set s: 2 of 2", "COM, set s: 1 of 2"],
    );
    both(
        [
            dampings([0.4, 0.6], [0.5, 0.7]),
            dampings([0.016, 0.019], [0.5, 0.7]),
        ],
        ["the ranges overlap", "the ranges are apart"],
    );
    both(
        [
            short_period("s", [-3.97, 3.86], [-3.97, 3.86], 0.01),
            short_period("s", [-1.74, 1.67], [-3.97, 3.86], 0.6),
        ],
        ["and the set trims", "but the set trims 60.00 % away"],
    );
    both(
        [sdcom(8, 3, 8, 0), sdcom(8, 3, 11, 3)],
        [
            "as many.",
            "prints 11, 3 complex flexible pairs among them, which cannot come from (27).",
        ],
    );
    both(
        [
            modal_data("s", origin("beam", Status::Derived), 0.001),
            modal_data("s", origin("table-3", Status::Derived), 3e-6),
        ],
        [
            "Table 3 is not among the sources",
            "This agreement is circular",
        ],
    );
    both(
        [
            clamped(origin("beam", Status::Derived), &[15.0], false),
            clamped(origin("table-3", Status::Unverified), &[16.2, 19.6], true),
        ],
        [
            "They are not the imaginary parts",
            "frequencies of the coupled vehicle, used here as clamped ones",
        ],
    );
    both(
        [
            mass("s", published, published),
            mass("s", published, origin("ahv-quoted", Status::Unverified)),
        ],
        [
            "I_yy published (source parker2007).",
            "unverified (source ahv-quoted): what depends on them",
        ],
    );
    assert!(pairing().text().contains("at most 25.00 % of the larger"));
}

//! The orders of convergence that `docs/integrators.md` prints.
#![forbid(unsafe_code)]

mod common;
#[path = "common/normal.rs"]
mod normal;
#[path = "common/order.rs"]
mod order;
#[path = "common/orders.rs"]
mod orders;
#[path = "common/stochastic.rs"]
mod stochastic;
#[path = "common/strong.rs"]
mod strong;
#[path = "common/weak.rs"]
mod weak;

use order::observed_order;

#[test]
fn the_methods_have_their_orders_and_the_documentation_says_so() {
    let rows = orders::observed();
    let table = orders::table(&rows);
    for row in &rows {
        // More is no fault: terms of a higher order are still felt where those of the order itself are small.
        let near = |observed: f64, order: u8| (-0.15..0.5).contains(&(observed - f64::from(order)));
        assert!(near(row.flight, row.order), "{}\n{table}", row.name);
        let mode = row.mode.is_none_or(|observed| near(observed, row.order));
        assert!(mode, "{}\n{table}", row.name);
        let dense = row
            .dense
            .is_none_or(|(order, observed)| near(observed, order));
        assert!(dense, "{}\n{table}", row.name);
    }
    documented(&table);
}

#[test]
fn the_schemes_have_their_orders_and_the_documentation_says_so() {
    let rows = stochastic::observed();
    let table = stochastic::table(&rows);
    let near = |(nominal, observed): stochastic::Order| (observed - nominal).abs() < 0.12;
    for row in &rows {
        assert!(near(row.weak), "{}\n{table}", row.name);
        assert!(row.strong.is_none_or(near), "{}\n{table}", row.name);
    }
    documented(&table);
}

#[test]
fn the_step_of_the_splitting_is_documented_as_the_benchmark_found_it() {
    let benchmark = include_str!("../../../docs/benchmarks.md");
    let (_, section) = benchmark
        .split_once("## A flight of SDCOM at equal weak error")
        .expect("the section");
    let between = |after: &str, before: &str| {
        let (_, rest) = section.split_once(after).expect(after);
        rest.split(before).next().expect("a part").trim()
    };
    let euler = between("Euler–Maruyama at ", " ms");
    let splitting = between("the splitting at ", " ms");
    let mut row = between("\n| splitting |", "\n").split('|');
    let ratio = row.nth(2).expect("the ratio").trim();
    let sentence = format!(
        "the splitting at {splitting} ms has no greater weak error than Euler–Maruyama at {euler} ms, and takes {ratio} of its time"
    );
    let documentation = include_str!("../../../docs/monte-carlo.md").split_whitespace();
    let documentation: Vec<_> = documentation.collect();
    assert!(documentation.join(" ").contains(&sentence), "{sentence}");
}

/// Checks that the documentation has this table.
fn documented(table: &str) {
    let documentation = include_str!("../../../docs/integrators.md");
    let mut lines = documentation.lines();
    let Some(head) = table.lines().next() else {
        panic!("the table is empty");
    };
    assert!(
        lines.any(|line| line == head),
        "no table in docs/integrators.md"
    );
    for (measured, documented) in table.lines().skip(1).zip(lines) {
        assert!(
            agree(measured, documented),
            "docs/integrators.md has another table than `cargo run -p ahv-integrate --example orders`:\n{table}"
        );
    }
}

/// Whether two lines are equal, numbers to a tenth: another table of coefficients moves them by less.
fn agree(measured: &str, documented: &str) -> bool {
    let cell = |pair: (&str, &str)| {
        let numbers = pair
            .0
            .trim()
            .parse::<f64>()
            .ok()
            .zip(pair.1.trim().parse::<f64>().ok());
        numbers.map_or(pair.0 == pair.1, |(a, b)| (a - b).abs() < 0.1)
    };
    measured.split('|').count() == documented.split('|').count()
        && measured.split('|').zip(documented.split('|')).all(cell)
}

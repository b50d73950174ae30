//! Designed samples.

/// Points of a Latin hypercube over 0 to 1: `columns` columns of `count` values. Of each variable every one of `count` equal intervals holds one
/// value. The same seed gives the same points.
#[must_use]
pub fn latin_hypercube(columns: usize, count: usize, seed: u64) -> Vec<Vec<f64>> {
    let column = |index: usize| {
        let mut state = mixed(seed ^ mixed(index as u64));
        let mut next = || {
            state = state.wrapping_add(1);
            mixed(state)
        };
        let mut cells: Vec<usize> = (0..count).collect();
        for last in (1..count).rev() {
            // The bias of the remainder is below 1e-12 for a million cells.
            cells.swap(last, (next() % (last as u64 + 1)) as usize);
        }
        let place = |cell: usize| {
            let inside = (next() >> 11) as f64 / (1_u64 << 53) as f64;
            (cell as f64 + inside) / count as f64
        };
        cells.into_iter().map(place).collect()
    };
    (0..columns).map(column).collect()
}

/// SplitMix64 of a counter: Steele, Lea, Flood, "Fast splittable pseudorandom number generators", 2014.
pub(crate) fn mixed(counter: u64) -> u64 {
    let mut bits = counter.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}

#[cfg(test)]
mod tests {
    use super::latin_hypercube;

    #[test]
    fn every_interval_of_every_variable_holds_one_value() {
        let columns = latin_hypercube(3, 1000, 7);
        for column in &columns {
            let mut cells: Vec<usize> = column.iter().map(|it| (it * 1000.0) as usize).collect();
            cells.sort_unstable();
            assert_eq!(cells, (0..1000).collect::<Vec<_>>());
        }
        // Variables are not ordered alike.
        let mean = |of: &dyn Fn(usize) -> f64| (0..1000).map(of).sum::<f64>() / 1000.0;
        let product = mean(&|row| (columns[0][row] - 0.5) * (columns[1][row] - 0.5));
        assert!(product.abs() * 12.0 < 0.1, "{product}");
        assert_eq!(columns, latin_hypercube(3, 1000, 7));
        assert_ne!(columns, latin_hypercube(3, 1000, 8));
    }
}

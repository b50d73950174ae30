//! Points for the tests of elementary functions.

/// Points that fill an interval evenly without a common fraction.
pub(crate) fn spread(low: f64, high: f64, count: u32) -> impl Iterator<Item = f64> {
    (0..count).map(move |k| low + (high - low) * (f64::from(k) * 0.618_033_988_749_894_9).fract())
}

/// A number, its neighbours and theirs, with both signs.
#[allow(dead_code, reason = "not every test file has edges")]
pub(crate) fn around(x: f64) -> impl Iterator<Item = f64> {
    let (up, down) = (x.next_up(), x.next_down());
    [x, up, up.next_up(), down, down.next_down()]
        .into_iter()
        .flat_map(|x| [x, -x])
}

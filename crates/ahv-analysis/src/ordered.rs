//! Work on many members that can be stopped.

use std::sync::atomic::{AtomicBool, AtomicU64};

use rayon::prelude::*;

/// Counts steps, and stops the work when asked to.
#[derive(Debug, Default)]
pub struct Control {
    /// Steps of members that are done.
    pub done: AtomicU64,
    /// Whether to stop.
    pub stop: AtomicBool,
}

/// What `make` makes of each item, up to the first of which it makes nothing, because it was stopped.
///
/// Items are taken in their order, on all threads: stopped, no more is lost than what was at work.
///
/// # Errors
///
/// One of those of `make`.
pub fn in_order<I: Send, T: Send, E: Send>(
    items: impl Iterator<Item = I> + Send,
    make: impl Fn(I) -> Result<Option<T>, E> + Sync + Send,
) -> Result<Vec<T>, E> {
    let made = items.enumerate().par_bridge();
    let made = made.map(|(place, item)| Ok((place, make(item)?)));
    let mut made: Vec<(usize, Option<T>)> = made.collect::<Result<_, E>>()?;
    made.sort_by_key(|(place, _)| *place);
    Ok(made.into_iter().map_while(|(_, it)| it).collect())
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use super::in_order;

    #[test]
    fn what_comes_after_a_gap_is_left_out() {
        let made = in_order(0..1000, |item| {
            Ok::<_, Infallible>((item != 700).then_some(item))
        });
        assert_eq!(made, Ok((0..700).collect()));
        let failed = in_order(
            0..10,
            |item| if item == 5 { Err(item) } else { Ok(Some(item)) },
        );
        assert_eq!(failed, Err(5));
    }
}

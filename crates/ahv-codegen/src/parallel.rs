//! Work that is shared by threads and comes back in order.

use std::sync::Mutex;
use std::thread;

/// What `work` makes of each item, in the order of the items.
pub(crate) fn map<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let next = Mutex::new(0..items.len());
    // A guard that is poisoned holds a count all the same; the panic itself goes on when the thread is joined.
    let take = || {
        next.lock()
            .unwrap_or_else(|poisoned| poisoned.into_inner())
            .next()
    };
    let share = || {
        let mut done = Vec::new();
        while let Some(position) = take() {
            done.push((position, work(&items[position])));
        }
        done
    };
    let mut done: Vec<(usize, R)> = thread::scope(|scope| {
        let workers: Vec<_> = (0..threads.min(items.len()))
            .map(|_| scope.spawn(share))
            .collect();
        let shares = workers.into_iter().map(|worker| worker.join());
        shares
            .flat_map(|share| share.unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
            .collect()
    });
    done.sort_unstable_by_key(|&(position, _)| position);
    done.into_iter().map(|(_, result)| result).collect()
}

#[cfg(test)]
mod tests {
    use super::map;

    #[test]
    fn results_stand_in_the_order_of_the_items() {
        let items: Vec<u64> = (0..100).collect();
        let squares: Vec<u64> = items.iter().map(|n| n * n).collect();
        assert_eq!(map(&items, |n| n * n), squares);
        assert!(map(&[] as &[u64], |n| *n).is_empty());
    }
}

//! Threads for the product's ensembles.

use rayon::{ThreadPool, ThreadPoolBuilder};

/// A pool of this many threads.
pub(crate) fn pool(threads: usize) -> Result<ThreadPool, String> {
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|error| format!("error: {error}"))
}

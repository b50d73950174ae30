//! Sources of normal numbers.

mod box_muller;
mod chacha;
mod keyed;
#[cfg(feature = "rand")]
mod sequential;

pub use box_muller::Precision;
pub use keyed::{KeyedNormals, NormalLanes, NormalStream, WienerSource};
#[cfg(feature = "rand")]
pub use sequential::RandNormals;

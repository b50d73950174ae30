//! Prints the orders of convergence of the deterministic methods, as `docs/integrators.md` has them.

#[path = "../tests/common/order.rs"]
mod order;
#[path = "../tests/common/orders.rs"]
mod orders;

use order::observed_order;

fn main() {
    print!("{}", orders::table(&orders::observed()));
}

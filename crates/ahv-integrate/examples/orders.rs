//! Prints the orders of convergence of the methods, as `docs/integrators.md` has them.

#[path = "../tests/common/mod.rs"]
mod common;
#[path = "../tests/common/normal.rs"]
mod normal;
#[path = "../tests/common/order.rs"]
mod order;
#[path = "../tests/common/orders.rs"]
mod orders;
#[path = "../tests/common/stochastic.rs"]
mod stochastic;
#[path = "../tests/common/strong.rs"]
mod strong;
#[path = "../tests/common/weak.rs"]
mod weak;

use order::observed_order;

fn main() {
    println!("{}", orders::table(&orders::observed()));
    print!("{}", stochastic::table(&stochastic::observed()));
}

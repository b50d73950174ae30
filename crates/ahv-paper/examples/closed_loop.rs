//! Prints the tables of `docs/closed-loop.md`: constants from the code, and what the controllers do, measured.

#[path = "../tests/common/closed_loop.rs"]
mod closed_loop;

fn main() {
    for table in closed_loop::tables() {
        println!("{table}");
    }
}

//! Reviews of the tables of this repository, and of changes in them.

mod changes;
mod common;
mod layout;
mod lint;

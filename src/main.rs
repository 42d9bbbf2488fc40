//! The `impactlab` program.

fn main() {}

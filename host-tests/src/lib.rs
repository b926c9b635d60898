//! Shared helpers of the host tests: the Cramér–Rao bound, an independent oracle, and streams through the core.

pub mod bound;

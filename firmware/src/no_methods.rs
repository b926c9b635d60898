//! Stands in for `methods.rs` without the feature `methods`, with the same interface, and takes no bytes and no cycles.

use antinode::{Block, Estimate, Sample, SamplePair};
use antinode_telemetry::Methods;

/// True if the methods are built in.
pub const AVAILABLE: bool = false;

/// No parameters.
#[derive(Debug, Clone, Copy)]
pub struct Tuning;

impl Tuning {
    /// The same for every estimate.
    pub fn of(_: &Estimate, _: f64) -> Self {
        Self
    }

    /// Always true.
    pub fn serves(&self, _: &Estimate, _: f64) -> bool {
        true
    }
}

/// Nothing goes with a block.
pub type Extra<S> = core::marker::PhantomData<S>;

/// Gathers nothing.
pub struct Gathering<S: Sample>(Extra<S>);

impl<S: Sample> Default for Gathering<S> {
    fn default() -> Self {
        Self::new()
    }
}

impl<S: Sample> Gathering<S> {
    /// Nothing.
    pub const fn new() -> Self {
        Self(core::marker::PhantomData)
    }

    /// Nothing.
    pub fn tune(&mut self, _: Option<Tuning>) {}

    /// Nothing.
    pub fn restart(&mut self) {}

    /// Nothing.
    #[inline(always)]
    pub fn add<P: SamplePair<S>>(&mut self, _: &[P], _: Option<&Block<S>>) -> Extra<S> {
        self.0
    }
}

/// Keeps nothing.
pub struct History<S: Sample>(Extra<S>);

impl<S: Sample> Default for History<S> {
    fn default() -> Self {
        Self::new()
    }
}

impl<S: Sample> History<S> {
    /// Nothing.
    pub const fn new() -> Self {
        Self(core::marker::PhantomData)
    }

    /// Nothing.
    pub fn keep(&mut self, _: &Extra<S>) {}

    /// Nothing.
    pub fn compare(&self, _: &Estimate, _: f64) -> Option<Methods> {
        None
    }
}

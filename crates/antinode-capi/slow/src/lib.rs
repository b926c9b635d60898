//! The part of the C ABI that does not run for each sample once the period is known: the search for a period, and the solution of windows.
//!
//! A crate of its own, because profiles set the optimisation by crate: `antinode-capi` has the sums at sample rate and is compiled for
//! speed, this one for size. Nothing here is generic: generic code would be compiled in `antinode-capi`.
#![no_std]
#![forbid(unsafe_code)]

use antinode::{Block, Estimate, Sample, Settings, SettingsError};

/// The longest period, sample pairs.
pub const LONGEST_PERIOD: usize = 200;
/// Blocks of the ring that windows are cut from.
pub const RING_BLOCKS: usize = 52;

/// The core's part at sample rate.
pub type Front<S> = antinode::Front<S, LONGEST_PERIOD>;
/// The core's part at window rate.
pub type Tracker = antinode::Tracker<RING_BLOCKS>;

/// The samples of the C ABI, with the calls that are compiled for size.
pub trait Slow: Sample {
    /// Drops the period and searches anew, with this number.
    fn search_wanted(front: &mut Front<Self>, number: u32);

    /// Searches for a period in pairs; returns how many it took.
    fn search(front: &mut Front<Self>, pairs: &[[Self; 2]]) -> usize;

    /// Reports that `count` pairs were lost.
    fn skip(front: &mut Front<Self>, count: u32);

    /// Takes a block; returns the estimate of the window that it completes, if any.
    fn solve(tracker: &mut Tracker, block: &Block<Self>) -> Option<Estimate>;
}

macro_rules! slow {
    ($sample:ty) => {
        impl Slow for $sample {
            #[cold]
            #[inline(never)]
            fn search_wanted(front: &mut Front<Self>, number: u32) {
                front.search_if_wanted(number);
            }

            #[inline(never)]
            fn search(front: &mut Front<Self>, pairs: &[[Self; 2]]) -> usize {
                // Callers have checked this; it lets the compiler leave out the sums.
                if !front.is_searching() {
                    return 0;
                }
                front.push_slice(pairs).0
            }

            #[inline(never)]
            fn skip(front: &mut Front<Self>, count: u32) {
                front.skip(u64::from(count));
            }

            #[inline(never)]
            fn solve(tracker: &mut Tracker, block: &Block<Self>) -> Option<Estimate> {
                tracker.push(block)
            }
        }
    };
}

slow!(i16);
slow!(f32);

/// Changes the settings; only the calibration may differ from the present ones.
///
/// # Errors
///
/// Those of [`antinode::Settings::check`]; nothing is changed then.
#[inline(never)]
pub fn change(tracker: &mut Tracker, settings: &Settings) -> Result<(), SettingsError> {
    tracker.change(*settings)
}

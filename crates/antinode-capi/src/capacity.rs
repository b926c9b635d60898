//! Capacities of a state, which give its size. Those that `slow/src/lib.rs` repeats must agree, which is checked below; the header follows.

use core::mem::{align_of, size_of};

use crate::state::State;

/// The shortest period that is searched for, sample pairs. If no frequency is given, a wave whose period is not between this and
/// ANTINODE_LONGEST_PERIOD is not found, unless sampling folds it to one that is. Then there is no estimate, and no flag and no status
/// shows why; only `has_wave` of antinode_health_t, which stays 0, shows it: watch it.
pub const ANTINODE_SHORTEST_PERIOD: usize = 4;
/// The longest period, sample pairs.
pub const ANTINODE_LONGEST_PERIOD: usize = 200;
/// The most periods a window may have.
pub const ANTINODE_MOST_PERIODS: usize = 50;
/// Finished blocks that the queue holds, including the one being solved. A block is two periods long, or a fifth of a window if that is
/// less; with a hop, half of this. It has at most ANTINODE_LONGEST_PERIOD sample pairs, and may be a little shorter, so that whole blocks
/// fit a window. At most ANTINODE_QUEUE_BLOCKS - 1 blocks should be finished between two calls of a `_solve` function, and by one call of
/// a `_push_block` function: at 18.75 samples a period, 15 blocks are 540 pairs in windows of ten periods and more, but 90 in windows of
/// two.
pub const ANTINODE_QUEUE_BLOCKS: usize = 16;

/// Blocks of the ring that windows are cut from: two more than the periods of the longest window.
pub(crate) const RING_BLOCKS: usize = ANTINODE_MOST_PERIODS + 2;

const _: () = assert!(
    ANTINODE_LONGEST_PERIOD == antinode_capi_slow::LONGEST_PERIOD
        && RING_BLOCKS == antinode_capi_slow::RING_BLOCKS,
    "slow/src/lib.rs has other capacities"
);

/// 64-bit words of an `antinode_fixed_t`.
pub const ANTINODE_FIXED_WORDS: usize = 1104;
/// 64-bit words of an `antinode_float_t`.
pub const ANTINODE_FLOAT_WORDS: usize = 1352;

/// State of an identification in fixed point, on `int16_t` codes. Opaque: only the functions `antinode_fixed_…` look inside.
#[repr(C)]
pub struct Fixed {
    words: [u64; ANTINODE_FIXED_WORDS],
}

/// State of an identification in single precision. Opaque: only the functions `antinode_float_…` look inside.
#[repr(C)]
pub struct Float {
    words: [u64; ANTINODE_FLOAT_WORDS],
}

impl Fixed {
    /// As a C program's `static antinode_fixed_t state;`: not initialised.
    pub const ZERO: Self = Self {
        words: [0; ANTINODE_FIXED_WORDS],
    };
}

impl Float {
    /// As a C program's `static antinode_float_t state;`: not initialised.
    pub const ZERO: Self = Self {
        words: [0; ANTINODE_FLOAT_WORDS],
    };
}

/// The size of an `antinode_fixed_t` in the library that is linked, bytes. May be called from anywhere.
#[allow(unsafe_code, reason = "`no_mangle` is an unsafe attribute")]
#[unsafe(no_mangle)]
pub extern "C" fn antinode_fixed_size() -> usize {
    size_of::<Fixed>()
}

/// The size of an `antinode_float_t` in the library that is linked, bytes. May be called from anywhere.
#[allow(unsafe_code, reason = "`no_mangle` is an unsafe attribute")]
#[unsafe(no_mangle)]
pub extern "C" fn antinode_float_size() -> usize {
    size_of::<Float>()
}

/// True when `Opaque` can hold `Inside`.
const fn holds<Opaque, Inside>() -> bool {
    size_of::<Inside>() <= size_of::<Opaque>() && align_of::<Inside>() <= align_of::<Opaque>()
}

const _: () = assert!(holds::<Fixed, State<i16>>(), "raise ANTINODE_FIXED_WORDS");
const _: () = assert!(holds::<Float, State<f32>>(), "raise ANTINODE_FLOAT_WORDS");

#[cfg(test)]
mod tests {
    use super::*;

    /// What a state may have to spare, bytes: compilers and machines differ by less.
    const MOST_SPARE: usize = 192;

    #[test]
    fn no_state_takes_much_more_than_it_holds() {
        let states = [
            (size_of::<Fixed>(), size_of::<State<i16>>()),
            (size_of::<Float>(), size_of::<State<f32>>()),
        ];
        let [fixed, float] = states.map(|(_, inside)| (inside + MOST_SPARE / 2) / 8);
        assert!(
            states
                .iter()
                .all(|(all, inside)| all - inside <= MOST_SPARE),
            "set ANTINODE_FIXED_WORDS to {fixed}, ANTINODE_FLOAT_WORDS to {float}"
        );
    }
}

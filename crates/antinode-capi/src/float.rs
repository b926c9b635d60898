//! The functions of `antinode_float_t`.
//!
//! What a caller must guarantee is said at the head of the header: a pointer that is neither NULL nor misaligned points to what its type
//! says, and each side of a state has one caller at a time.
#![allow(
    unsafe_code,
    unsafe_op_in_unsafe_fn,
    clippy::missing_safety_doc,
    reason = "exported names; each hands its arguments and its caller's contract on to `boundary`"
)]

use crate::boundary;
use crate::capacity::Float;
use crate::estimate::Estimate;
use crate::settings::{Calibration, Settings};
use crate::state::Health;
use crate::status::Status;

/// Initialises a state from cold. Returns ANTINODE_OK, or what is wrong with the settings; the state is then not initialised. Call it
/// before any other function, while neither side runs. Only an interrupt of the same core may break in; ANTINODE_ERROR_NOT_INITIALISED
/// tells it that its pairs were not taken. To go on with other settings call it again, with the last angle as `start_angle_rad` and the
/// last frequency as `frequency_hz`, so that no search is needed; no other wave is then found. Times begin at 0 again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn antinode_float_init(
    state: *mut Float,
    settings: *const Settings,
) -> Status {
    boundary::init::<f32, _>(state, settings)
}

/// Returns a state to what it was after its initialisation, except for the calibration, which is kept. It may be called when
/// antinode_float_init() may.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn antinode_float_reset(state: *mut Float) -> Status {
    boundary::reset::<f32, _>(state)
}

/// Interrupt side. Takes one sample pair, in any unit. Returns ANTINODE_OK; ANTINODE_READY if the pair finished a block; ANTINODE_DROPPED
/// if that block had to be dropped.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn antinode_float_push(state: *mut Float, c: f32, d: f32) -> Status {
    boundary::push(state, [c, d])
}

/// Interrupt side. Takes `count` sample pairs from two arrays, in any unit. Returns the same as antinode_float_push().
#[unsafe(no_mangle)]
pub unsafe extern "C" fn antinode_float_push_block(
    state: *mut Float,
    c: *const f32,
    d: *const f32,
    count: usize,
) -> Status {
    boundary::push_separate(state, c, d, count)
}

/// Interrupt side. Takes `count` sample pairs from one array of 2 × `count` samples, C and D in turn, in any unit. Returns the same as
/// antinode_float_push().
#[unsafe(no_mangle)]
pub unsafe extern "C" fn antinode_float_push_block_interleaved(
    state: *mut Float,
    samples: *const f32,
    count: usize,
) -> Status {
    boundary::push_pairs::<f32, _, _>(state, samples.cast::<[f32; 2]>(), count)
}

/// Interrupt side. Takes `count` sample pairs of 16-bit codes, C in the low half of a word and D in the high half, as a dual
/// converter's DMA leaves them; pass unsigned codes of 16 bits as `word ^ 0x80008000`, see the head of the header. Returns the same as
/// antinode_float_push().
#[unsafe(no_mangle)]
pub unsafe extern "C" fn antinode_float_push_block_packed(
    state: *mut Float,
    words: *const u32,
    count: usize,
) -> Status {
    boundary::push_pairs::<f32, _, _>(state, words.cast::<antinode::Packed>(), count)
}

/// Interrupt side. Reports that `count` sample pairs were lost before the next one: the window that they would have been part of is
/// dropped, and `start` and `time_s` of later windows count them, even if no pair was pushed yet. After a gap so long that the turn of the
/// pattern meanwhile is known to no better than 0.13 rad (one standard deviation), the angle is known modulo π/2 only, and
/// ANTINODE_FLAG_REACQUIRED says so.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn antinode_float_skip(state: *mut Float, count: u32) -> Status {
    boundary::skip::<f32, _>(state, count)
}

/// Thread side. Solves finished blocks up to the next estimate. Returns ANTINODE_ESTIMATE if one was written: there may then be more.
/// Returns ANTINODE_OK if no block is left, or if ANTINODE_QUEUE_BLOCKS blocks gave no estimate: `estimate` is then unchanged. A lost wave
/// is searched for anew without a call. Estimates come in order of time: a full queue keeps its oldest blocks, so the first estimates after
/// a stall of this side are as old as the stall, and no flag shows it. Compare `start` + `samples` with a count of the pairs pushed and
/// skipped.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn antinode_float_solve(
    state: *mut Float,
    estimate: *mut Estimate,
) -> Status {
    boundary::solve::<f32, _>(state, estimate)
}

/// Thread side. Drops the wave and searches anew; the angle continues from the last one, modulo π/2.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn antinode_float_search(state: *mut Float) -> Status {
    boundary::search::<f32, _>(state)
}

/// Thread side. Changes the calibration from the next block on; the window begun is dropped, and the next one is flagged
/// ANTINODE_FLAG_REACQUIRED. A calibration out of range changes nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn antinode_float_set_calibration(
    state: *mut Float,
    calibration: *const Calibration,
) -> Status {
    boundary::calibrate::<f32, _>(state, calibration)
}

/// Either side. Reads the state of the identification: whether it searches, has a wave, and loses blocks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn antinode_float_health(state: *const Float, health: *mut Health) -> Status {
    boundary::health::<f32, _>(state, health)
}

/// Both sides in one call, for use without an interrupt: takes sample pairs from `samples`, C and D in turn, up to the end of a window, and
/// writes how many it took to `taken`. Returns ANTINODE_ESTIMATE if a window ended and its estimate was written: call it again with the
/// rest. Returns ANTINODE_OK if all `count` pairs were taken without an estimate.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn antinode_float_identify(
    state: *mut Float,
    samples: *const f32,
    count: usize,
    taken: *mut usize,
    estimate: *mut Estimate,
) -> Status {
    boundary::identify_pairs(state, samples.cast::<[f32; 2]>(), count, taken, estimate)
}

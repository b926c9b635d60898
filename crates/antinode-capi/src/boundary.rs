//! Turns C's pointers into references: each pointer is checked first, and each side of a state gets its own part only.
#![allow(
    unsafe_code,
    reason = "pointers from C; besides this, only the queue and the exported names need it"
)]

use core::mem::MaybeUninit;
use core::sync::atomic::{Ordering, compiler_fence};

use antinode::{Packed, SamplePair};

use crate::capacity::RING_BLOCKS;
use crate::estimate::Estimate;
use crate::interrupt::{AT_ONCE, Interrupt, Words};
use crate::settings::{Calibration, Settings};
use crate::state::{Arithmetic, Health, Shared, State, Thread, identify};
use crate::status::Status;

type Checked<T> = Result<T, Status>;

/// Refuses a pointer that is NULL or misaligned.
#[inline]
fn check<T>(pointer: *const T) -> Checked<()> {
    if pointer.is_null() {
        Err(Status::ErrorNull)
    } else if !pointer.is_aligned() {
        Err(Status::ErrorAlignment)
    } else {
        Ok(())
    }
}

/// An opaque state as its inner type, if it is initialised.
///
/// # Safety
/// `opaque` is NULL, misaligned, or points to memory of the caller's for a whole state.
#[inline]
unsafe fn open<S: Arithmetic, O>(opaque: *mut O) -> Checked<*mut State<S>> {
    check(opaque)?;
    let state = opaque.cast::<State<S>>();
    // SAFETY: the memory is the caller's and large enough, and any bits are a valid number. Relaxed order will do: by the contract an
    // initialisation is over before any other call begins.
    let magic = unsafe { (*state).magic.load(Ordering::Relaxed) };
    if magic == S::MAGIC {
        Ok(state)
    } else {
        Err(Status::ErrorNotInitialised)
    }
}

/// The interrupt's part of a state, and the part that both sides share.
///
/// # Safety
/// As [`open`]; no other call of the interrupt's side is under way.
#[inline]
unsafe fn interrupt<'a, S: Arithmetic, O>(
    opaque: *mut O,
) -> Checked<(&'a mut Interrupt<S>, &'a Shared<S>)> {
    // SAFETY: initialised, and this part has one user.
    unsafe { open(opaque).map(|state| (&mut (*state).interrupt, &(*state).shared)) }
}

/// The thread's part of a state, and the part that both sides share.
///
/// # Safety
/// As [`open`]; no other call of the thread's side is under way.
#[inline]
unsafe fn thread<'a, S: Arithmetic, O>(opaque: *mut O) -> Checked<(&'a mut Thread, &'a Shared<S>)> {
    // SAFETY: initialised, and this part has one user.
    unsafe { open(opaque).map(|state| (&mut (*state).thread, &(*state).shared)) }
}

/// An array of `count` elements.
///
/// # Safety
/// `first` is NULL, misaligned, or points to `count` elements.
#[inline]
unsafe fn slice<'a, T>(first: *const T, count: usize) -> Checked<&'a [T]> {
    check(first)?;
    if count > isize::MAX as usize / size_of::<T>().max(1) {
        return Err(Status::ErrorCount);
    }
    // SAFETY: aligned, not NULL, and no larger than an object may be.
    Ok(unsafe { core::slice::from_raw_parts(first, count) })
}

fn status(result: Checked<Status>) -> Status {
    result.unwrap_or_else(|error| error)
}

/// # Safety
/// `opaque` as in [`open`], `settings` NULL, misaligned or readable; nobody else uses the state.
pub(crate) unsafe fn init<S: Arithmetic, O>(opaque: *mut O, settings: *const Settings) -> Status {
    status((|| {
        check(opaque)?;
        // SAFETY: the memory is the caller's. Before the settings are checked: if they are refused, no older state may remain in use.
        unsafe { close::<S>(opaque.cast()) };
        check(settings)?;
        // SAFETY: checked.
        let settings = unsafe { &*settings }.checked(RING_BLOCKS)?;
        // SAFETY: the caller's contract.
        unsafe { start::<S>(opaque.cast(), settings) }
    })())
}

/// # Safety
/// As [`init`].
pub(crate) unsafe fn reset<S: Arithmetic, O>(opaque: *mut O) -> Status {
    // SAFETY: the caller's contract.
    status(unsafe {
        open::<S, O>(opaque).and_then(|state| {
            close(state);
            start(state, *(*state).thread.settings())
        })
    })
}

/// Marks a state as not initialised before anything else in it is written: calls from an interrupt that breaks in are then refused.
///
/// # Safety
/// `state` points to memory for one.
#[inline]
unsafe fn close<S: Arithmetic>(state: *mut State<S>) {
    // SAFETY: the caller's contract.
    unsafe { (*state).magic.store(0, Ordering::Relaxed) };
    compiler_fence(Ordering::SeqCst);
}

/// Initialises a closed state part by part, each in place, so that none passes over the stack.
///
/// # Safety
/// `state` points to memory for one that nobody else uses.
unsafe fn start<S: Arithmetic>(
    state: *mut State<S>,
    settings: antinode::Settings,
) -> Checked<Status> {
    // SAFETY: the memory is writable and aligned; what was in it needs no drop.
    unsafe {
        Shared::write(&raw mut (*state).shared, settings.frequency.is_none());
        Interrupt::write(&raw mut (*state).interrupt, settings)?;
        Thread::write(&raw mut (*state).thread, settings)?;
        (*state).magic.store(S::MAGIC, Ordering::Release);
    }
    Ok(Status::Ok)
}

/// # Safety
/// As [`interrupt`].
#[inline]
pub(crate) unsafe fn push<S: Arithmetic, O>(opaque: *mut O, pair: [S; 2]) -> Status {
    // SAFETY: the caller's contract.
    status(unsafe { interrupt(opaque).map(|(side, shared)| side.push_one(shared, pair)) })
}

/// # Safety
/// As [`interrupt`] and [`slice()`].
#[inline]
pub(crate) unsafe fn push_pairs<S: Arithmetic, O, P: SamplePair<S>>(
    opaque: *mut O,
    pairs: *const P,
    count: usize,
) -> Status {
    // SAFETY: the caller's contract.
    status(unsafe {
        interrupt::<S, O>(opaque)
            .and_then(|(side, shared)| Ok(side.push(shared, slice(pairs, count)?)))
    })
}

/// # Safety
/// As [`interrupt`] and [`slice()`].
pub(crate) unsafe fn push_words<O>(opaque: *mut O, words: *const u32, count: usize) -> Status {
    if cfg!(target_endian = "big") {
        // SAFETY: the caller's contract.
        return unsafe { push_pairs::<i16, O, _>(opaque, words.cast::<Packed>(), count) };
    }
    status((|| {
        // SAFETY: the caller's contract.
        let (side, shared) = unsafe { interrupt::<i16, O>(opaque)? };
        // SAFETY: the caller's contract.
        let words = unsafe { slice(words, count)? };
        // In little-endian order a word has the same bytes as C and D in turn: the same code serves both.
        // SAFETY: a pair has as many bytes as a word and no stricter alignment; one caller at a time.
        Ok(unsafe {
            let pairs = core::slice::from_raw_parts(words.as_ptr().cast::<[i16; 2]>(), count);
            side.push(shared, pairs)
        })
    })())
}

/// # Safety
/// As [`interrupt`] and [`slice()`], for both arrays.
pub(crate) unsafe fn push_separate<S: Arithmetic, O>(
    opaque: *mut O,
    c: *const S,
    d: *const S,
    count: usize,
) -> Status {
    status((|| {
        // SAFETY: the caller's contract.
        let (side, shared) = unsafe { interrupt::<S, O>(opaque)? };
        // SAFETY: the caller's contract.
        let (c, d) = unsafe { (slice(c, count)?, slice(d, count)?) };
        let mut all = Status::Ok;
        for (c, d) in c.chunks(AT_ONCE).zip(d.chunks(AT_ONCE)) {
            let mut pairs = Words([const { MaybeUninit::uninit() }; AT_ONCE]);
            for (pair, (&c, &d)) in pairs.0.iter_mut().zip(c.iter().zip(d)) {
                pair.write([c, d]);
            }
            // SAFETY: so many pairs were just written (a chunk has at most AT_ONCE); else the caller's contract.
            let one = unsafe {
                let first = pairs.0.as_ptr().cast::<[S; 2]>();
                side.push(
                    shared,
                    core::slice::from_raw_parts(first, c.len().min(d.len())),
                )
            };
            all = all.max(one);
        }
        Ok(all)
    })())
}

/// # Safety
/// As [`interrupt`].
pub(crate) unsafe fn skip<S: Arithmetic, O>(opaque: *mut O, count: u32) -> Status {
    // SAFETY: the caller's contract.
    status(unsafe { interrupt::<S, O>(opaque) }.map(|(side, shared)| {
        side.skip(shared, count);
        Status::Ok
    }))
}

/// # Safety
/// As [`thread`]; `estimate` NULL, misaligned or writable.
pub(crate) unsafe fn solve<S: Arithmetic, O>(opaque: *mut O, estimate: *mut Estimate) -> Status {
    status((|| {
        // SAFETY: the caller's contract.
        let (side, shared) = unsafe { thread::<S, O>(opaque)? };
        check(estimate)?;
        // SAFETY: the caller's contract.
        Ok(match unsafe { side.solve(shared) } {
            Some(found) => {
                // SAFETY: checked.
                unsafe { estimate.write(found) };
                Status::Estimate
            }
            None => Status::Ok,
        })
    })())
}

/// # Safety
/// As [`thread`].
pub(crate) unsafe fn search<S: Arithmetic, O>(opaque: *mut O) -> Status {
    // SAFETY: the caller's contract.
    status(unsafe { thread::<S, O>(opaque) }.map(|(side, shared)| {
        side.search(shared);
        Status::Ok
    }))
}

/// # Safety
/// As [`thread`]; `calibration` NULL, misaligned or readable.
pub(crate) unsafe fn calibrate<S: Arithmetic, O>(
    opaque: *mut O,
    calibration: *const Calibration,
) -> Status {
    status((|| {
        // SAFETY: the caller's contract.
        let (side, _) = unsafe { thread::<S, O>(opaque)? };
        check(calibration)?;
        // SAFETY: checked.
        side.calibrate(unsafe { *calibration }.into())?;
        Ok(Status::Ok)
    })())
}

/// # Safety
/// As [`open`]; `health` NULL, misaligned or writable.
pub(crate) unsafe fn health<S: Arithmetic, O>(opaque: *const O, health: *mut Health) -> Status {
    status((|| {
        // SAFETY: the caller's contract; only atomics are read.
        let state = unsafe { open::<S, O>(opaque.cast_mut())? };
        check(health)?;
        // SAFETY: both are checked.
        unsafe { health.write((*state).shared.health()) };
        Ok(Status::Ok)
    })())
}

/// # Safety
/// As [`interrupt`], [`thread`] and [`slice()`]; `taken` and `estimate` NULL, misaligned or writable.
pub(crate) unsafe fn identify_pairs<S: Arithmetic, O>(
    opaque: *mut O,
    pairs: *const [S; 2],
    count: usize,
    taken: *mut usize,
    estimate: *mut Estimate,
) -> Status {
    status((|| {
        // SAFETY: the caller's contract.
        let state = unsafe { open::<S, O>(opaque)? };
        // SAFETY: the caller's contract.
        let pairs = unsafe { slice(pairs, count)? };
        check(taken)?;
        check(estimate)?;
        // SAFETY: nobody else uses the interrupt's and the thread's part of this state; `health` reads only atomics of the shared part.
        let (count, found) = unsafe {
            let (interrupt, thread) = (&mut (*state).interrupt, &mut (*state).thread);
            identify((interrupt, thread, &(*state).shared), pairs)
        };
        // SAFETY: checked.
        unsafe { taken.write(count) };
        Ok(match found {
            Some(found) => {
                // SAFETY: checked.
                unsafe { estimate.write(found) };
                Status::Estimate
            }
            None => Status::Ok,
        })
    })())
}

//! A call with a bad pointer or count does nothing: the rows are those of a run without it.
#![allow(unsafe_code, reason = "the functions of a C ABI")]

use std::ptr::{null, null_mut};

use antinode_capi::*;

use crate::core_rows::{RATE, codes, rows, same};
use crate::gyro::{Arithmetic, Gyro, Way, unwritten};

/// A pointer moved by one byte, which misaligns it for any type larger than a byte.
fn odd<T>(pointer: *const T) -> *const T {
    pointer.wrapping_byte_add(1)
}

static WORD: u32 = 0x0123_4567;

/// Calls every function that takes more than a state, with each of its arguments wrong in each way.
fn make_mistakes<S: Arithmetic>(gyro: &mut Gyro<S>) {
    use Status::{ErrorAlignment, ErrorCount, ErrorNull};
    let abi = S::ABI;
    let state = gyro.pointer();
    let pair = [S::from(1_000), S::from(2_000)];
    let (one, word) = (pair.as_ptr(), &raw const WORD);
    let (mut taken, mut estimate) = (99, unwritten());
    let (taken, estimate) = (&raw mut taken, &raw mut estimate);
    let most = usize::MAX;
    // SAFETY: a pointer that is bad, or points to less than the count says, is refused before it is read.
    unsafe {
        for (wrong, status) in [(null(), ErrorNull), (odd(one), ErrorAlignment)] {
            assert_eq!((abi.separate)(state, wrong, one, 1), status);
            assert_eq!((abi.separate)(state, one, wrong, 1), status);
            assert_eq!((abi.interleaved)(state, wrong, 1), status);
            assert_eq!((abi.identify)(state, wrong, 1, taken, estimate), status);
        }
        assert_eq!((abi.separate)(state, one, one, most), ErrorCount);
        assert_eq!((abi.interleaved)(state, one, most), ErrorCount);
        assert_eq!((abi.packed)(state, word, most), ErrorCount);
        let identified = (abi.identify)(state, one, most, taken, estimate);
        assert_eq!(identified, ErrorCount);
        assert_eq!((abi.packed)(state, null(), 1), ErrorNull);
        assert_eq!((abi.packed)(state, odd(word), 1), ErrorAlignment);

        let estimates = [(null(), ErrorNull), (odd(estimate), ErrorAlignment)];
        for (wrong, status) in estimates.map(|(wrong, status)| (wrong.cast_mut(), status)) {
            assert_eq!((abi.solve)(state, wrong), status);
            assert_eq!((abi.identify)(state, one, 1, taken, wrong), status);
        }
        for (wrong, status) in [
            (null_mut(), ErrorNull),
            (odd(taken).cast_mut(), ErrorAlignment),
        ] {
            assert_eq!((abi.identify)(state, one, 1, wrong, estimate), status);
        }
        assert_eq!((abi.set_calibration)(state, null()), ErrorNull);
        let calibration = antinode_settings_default(RATE).calibration;
        let wrong = odd(&raw const calibration);
        assert_eq!((abi.set_calibration)(state, wrong), ErrorAlignment);
        assert_eq!((abi.health)(state, null_mut()), ErrorNull);
        // A count of 0 is no mistake.
        assert_eq!((abi.separate)(state, one, one, 0), Status::Ok);
        assert_eq!((abi.interleaved)(state, one, 0), Status::Ok);
        assert_eq!((abi.packed)(state, word, 0), Status::Ok);
        assert_eq!((*taken, *estimate), (99, unwritten()));
    }
}

fn a_mistake_does_nothing<S: Arithmetic>() {
    let codes = codes(4_000, 5_332.0);
    let settings = antinode_settings_default(RATE);
    let mut gyro = Gyro::<S>::new(&settings);
    let mut ours = Vec::new();
    for piece in codes.chunks(250) {
        make_mistakes(&mut gyro);
        gyro.push(Way::Packed, piece);
        // Blocks wait now, and none may be lost.
        make_mistakes(&mut gyro);
        ours.extend(gyro.rows());
    }
    same("mistakes", &ours, &rows::<S>(&settings, &codes));
}

#[test]
fn a_mistake_does_nothing_in_both() {
    a_mistake_does_nothing::<i16>();
    a_mistake_does_nothing::<f32>();
}

fn a_state_of_the_other_arithmetic_is_refused<S: Arithmetic, Other: Arithmetic>() {
    let mut other = Gyro::<Other>::new(&antinode_settings_default(RATE));
    let state = other.pointer().cast::<S::State>();
    for (state, status) in [
        (null_mut(), Status::ErrorNull),
        (odd(state).cast_mut(), Status::ErrorAlignment),
        (state, Status::ErrorNotInitialised),
    ] {
        // SAFETY: a bad state is refused before anything but its mark is read.
        let answer = unsafe { (S::ABI.push)(state, S::from(0), S::from(0)) };
        assert_eq!(answer, status);
    }
}

#[test]
fn a_state_of_the_other_arithmetic_is_refused_in_both() {
    a_state_of_the_other_arithmetic_is_refused::<i16, f32>();
    a_state_of_the_other_arithmetic_is_refused::<f32, i16>();
}

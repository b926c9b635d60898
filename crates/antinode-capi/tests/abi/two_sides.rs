//! Both sides at once, on two threads, while a third calls `_health`: whatever the thread side asks for, rows are right.
#![allow(unsafe_code, reason = "the functions of a C ABI, from several threads")]

use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{scope, yield_now};

use antinode_capi::*;

use crate::core_rows::{RATE, TURN, codes};
use crate::gyro::{Arithmetic, Gyro, unwritten};

/// How often the thread side asks for a search or a calibration, and the rows that it takes after each.
const ASKED: usize = 60;
const AFTER: usize = 4;

/// A state that all threads call.
struct Shared<T>(*mut T);

// SAFETY: each thread calls the functions of its own side, which may be under way at once.
unsafe impl<T> Sync for Shared<T> {}

impl<T> Shared<T> {
    fn health<S: Arithmetic<State = T>>(&self) -> Health {
        let mut health = Health {
            searching: 9,
            has_wave: 9,
            waiting: 99,
            dropped: 9,
        };
        // SAFETY: `_health` may be called from anywhere; a refused call leaves values that no state has.
        unsafe { (S::ABI.health)(self.0, &mut health) };
        health
    }

    /// Pushes as a converter does, but waits for the thread side; true if every status was good.
    fn interrupt<S: Arithmetic<State = T>>(
        &self,
        samples: &[[S; 2]],
        is_over: &AtomicBool,
    ) -> bool {
        for piece in samples.chunks(50) {
            while self.health::<S>().waiting > 12 && !is_over.load(Ordering::Relaxed) {
                yield_now();
            }
            if is_over.load(Ordering::Relaxed) {
                return true;
            }
            // SAFETY: the only caller of this side.
            let status =
                unsafe { (S::ABI.interleaved)(self.0, piece.as_ptr().cast(), piece.len()) };
            if status != Status::Ok && status != Status::Ready {
                return false;
            }
        }
        false
    }

    /// In turn asks for a search and sets a calibration, and takes rows after each, until the pairs end.
    fn thread<S: Arithmetic<State = T>>(&self, is_at_end: &AtomicBool) -> Vec<Vec<Estimate>> {
        let calibration = antinode_settings_default(RATE).calibration;
        let mut all = Vec::new();
        for i in 0..ASKED {
            // SAFETY: the only caller of this side, here and below.
            unsafe {
                match i % 2 {
                    0 => (S::ABI.search)(self.0),
                    _ => (S::ABI.set_calibration)(self.0, &calibration),
                };
            }
            let mut rows = Vec::new();
            while rows.len() < AFTER {
                let mut row = unwritten();
                // SAFETY: as above.
                if unsafe { (S::ABI.solve)(self.0, &mut row) } == Status::Estimate {
                    rows.push(row);
                } else if is_at_end.load(Ordering::Relaxed) {
                    break;
                }
            }
            all.push(rows);
        }
        all
    }
}

fn rows_are_sound_whatever_is_asked<S: Arithmetic>() {
    let samples: Vec<[S; 2]> = codes(400_000, 5_332.0)
        .into_iter()
        .map(|pair| pair.map(S::from))
        .collect();
    let mut gyro = Gyro::<S>::new(&antinode_settings_default(RATE));
    let shared = &Shared(gyro.pointer());
    let (is_over, is_at_end) = (&AtomicBool::new(false), &AtomicBool::new(false));
    // Nothing is asserted before all threads have ended: a thread that panicked would leave the others waiting.
    let (were_good, were_sound, rows) = scope(|scope| {
        let interrupt = scope.spawn(move || {
            let were_good = shared.interrupt::<S>(&samples, is_over);
            is_at_end.store(true, Ordering::Relaxed);
            were_good
        });
        let onlooker = scope.spawn(move || {
            let mut are_sound = true;
            while !is_over.load(Ordering::Relaxed) {
                let health = shared.health::<S>();
                are_sound &= health.searching <= 1 && health.has_wave <= 1;
                are_sound &= health.waiting as usize <= ANTINODE_QUEUE_BLOCKS;
                are_sound &= health.dropped == 0;
                yield_now();
            }
            are_sound
        });
        let rows = shared.thread::<S>(is_at_end);
        is_over.store(true, Ordering::Relaxed);
        (interrupt.join().unwrap(), onlooker.join().unwrap(), rows)
    });
    assert!(were_good && were_sound);
    let mut end = 0;
    for (i, rows) in rows.iter().enumerate() {
        assert_eq!(rows.len(), AFTER);
        for (k, row) in rows.iter().enumerate() {
            let is_first = k == 0 && i > 0;
            let flags = u32::from(is_first) * ANTINODE_FLAG_REACQUIRED;
            assert_eq!(row.flags, flags, "asked {i}, row {k}: {row:?}");
            assert!(row.start >= end, "asked {i}, row {k}: {row:?}");
            end = row.start + u64::from(row.samples);
            let off = row.angle_rad - (0.35 + TURN * row.time_s);
            // The angle is continued: not even a quarter turn is lost.
            assert!(off.abs() < 1e-3, "asked {i}, row {k}: {off} {row:?}");
        }
    }
}

#[test]
fn rows_are_sound_whatever_is_asked_in_both() {
    rows_are_sound_whatever_is_asked::<i16>();
    rows_are_sound_whatever_is_asked::<f32>();
}

//! Kernels to compare those of [`bench`](crate::bench) with, over the same codes between the same marks.

use core::hint::black_box;
use core::num::Wrapping;

use antinode::methods::{DelayedSums, MomentSums};
use antinode::{Packed, Sample, SamplePair};
use idsp::{Accu, cossin};

use crate::bench::{PAIRS, demodulator};
use crate::codes::{Codes, HALF_BUFFER, PERIOD};
use crate::gauge::{Gauge, apart};

/// The four sums of (24), written with idsp: a phase accumulator, `cossin`, and products added in 64 bits.
struct IdspSums {
    phase: Accu<Wrapping<i32>>,
    /// S_C times cosine and sine, then S_D times cosine and sine.
    sums: [i64; 4],
}

impl IdspSums {
    // Not inlined, so that the loop has more registers.
    #[inline(never)]
    fn extend(&mut self, pairs: &[Packed]) {
        // Copies stay in registers.
        let (mut phase, [mut cc, mut cs, mut dc, mut ds]) = (self.phase, self.sums);
        for (pair, angle) in pairs.iter().zip(&mut phase) {
            let (cosine, sine) = cossin(angle.0);
            let [c, d] = SamplePair::<i16>::pair(*pair).map(i32::from);
            cc += i64::from(c) * i64::from(cosine);
            cs += i64::from(c) * i64::from(sine);
            dc += i64::from(d) * i64::from(cosine);
            ds += i64::from(d) * i64::from(sine);
        }
        (self.phase, self.sums) = (phase, [cc, cs, dc, ds]);
    }
}

/// The sums of half-buffers with idsp.
pub fn idsp_sums(name: &'static str) -> ! {
    let codes = Codes::new();
    let step = (4_294_967_296.0 / PERIOD) as u32 as i32;
    let mut kernel = IdspSums {
        phase: Accu::new(Wrapping(0), Wrapping(step)),
        sums: [0; 4],
    };
    let mut gauge = Gauge::new(name, PAIRS, size_of::<IdspSums>());
    gauge.start();
    apart(|| {
        half_buffers(&codes, |pairs| kernel.extend(pairs));
        black_box(&kernel.sums);
    });
    gauge.finish()
}

/// The block sums together with the sums of all four methods; `bench_block_f32` and `_fixed` measure the demodulator alone.
pub fn methods<S: Sample>(name: &'static str) -> !
where
    Packed: SamplePair<S>,
{
    let codes = Codes::new();
    let offsets = [20.0, -15.0];
    let mut demodulator = demodulator::<S>(false);
    let mut moments = MomentSums::<S>::new(offsets);
    // A lag of a quarter period, in a delay line for the longest period.
    let mut delayed = DelayedSums::<50, S>::new(5, offsets);
    let state = size_of_val(&demodulator) + size_of_val(&moments) + size_of_val(&delayed);
    let mut gauge = Gauge::new(name, PAIRS, state);
    let mut blocks = 0;
    let mut run = |pairs: &[Packed]| {
        // The methods' sums take several blocks at once, up to the end of a window.
        let (mut at, mut window) = (0, 0);
        while at < pairs.len() {
            let (taken, block) = demodulator.push_slice(pairs.get(at..).unwrap_or(&[]));
            at += taken;
            if block.is_some() {
                blocks += 1;
            }
            if blocks == 5 || at == pairs.len() {
                let new = pairs.get(window..at).unwrap_or(&[]);
                moments.extend(new);
                delayed.extend(new);
                window = at;
            }
            if blocks == 5 {
                black_box((moments.take(), delayed.take()));
                blocks = 0;
            }
        }
    };
    // The first block makes the table.
    run(codes.slice(0, 100));
    gauge.start();
    apart(|| half_buffers(&codes, run));
    gauge.finish()
}

/// No kernel: the cost that every bench image has.
pub fn nothing(name: &'static str) -> ! {
    let codes = Codes::new();
    let mut gauge = Gauge::new(name, PAIRS, 0);
    gauge.start();
    apart(|| half_buffers(&codes, |pairs| _ = black_box(pairs)));
    gauge.finish()
}

/// Hands over [`PAIRS`] pairs in half-buffers.
#[inline(always)]
fn half_buffers(codes: &Codes, mut take: impl FnMut(&[Packed])) {
    let mut at = 0;
    while at < PAIRS {
        let pairs = codes.slice(at, HALF_BUFFER.min(PAIRS - at));
        at += pairs.len();
        take(pairs);
    }
}

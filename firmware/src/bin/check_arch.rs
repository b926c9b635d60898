//! Verifies on the target that every assembly kernel of the core agrees with its portable twin bit for bit, over extremes and random
//! words. It leaves the emulator with success or failure and names the kernels that differ.
#![no_std]
#![no_main]

// The core's own file, as the module is not public.
#[allow(
    dead_code,
    reason = "the parts of kernels are not called by themselves"
)]
#[path = "../../../crates/antinode/src/arch/mod.rs"]
mod arch;
// The modules that this file imports from.
mod block {
    pub use antinode::block::{ChannelSums, ChannelWatch};
}
mod sample {
    pub use antinode::{Form, SamplePair};
}

use antinode::SamplePair;
use arch::portable;
use block::{ChannelSums, ChannelWatch};
use cortex_m_rt::entry;
use firmware::marks;
use firmware::text::TextLine;

#[cfg(not(all(has_dsp, has_vsqrt)))]
compile_error!("without the instructions there is nothing to compare with the twins");

/// Random words for each kernel on single words.
const WORDS: u32 = 100_000;
/// Slices for each kernel on slices.
const SLICES: u32 = 4_000;
/// Most pairs of a slice.
const MAX_PAIRS: usize = 64;
/// Halves at which sums or signs may overflow or change.
const HALVES: [u16; 8] = [0, 1, 2, 0x7ffe, 0x7fff, 0x8000, 0x8001, 0xffff];
/// Zeros, subnormals, ones, the ends of the range, infinities, NaN.
const FLOATS: [u32; 12] = [
    0,
    0x8000_0000,
    1,
    0x007f_ffff,
    0x0080_0000,
    0x3f80_0000,
    0x3f7f_ffff,
    0x7f7f_ffff,
    0x7f80_0000,
    0xff80_0000,
    0x7fc0_0000,
    0xbf80_0000,
];

/// A seeded sequence of words: xorshift, G. Marsaglia, 2003, DOI 10.18637/jss.v008.i14.
struct Random(u32);

impl Random {
    fn word(&mut self) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        self.0
    }

    /// A random word, in one case of four with both halves extreme.
    fn rough_word(&mut self) -> u32 {
        let word = self.word();
        if self.word() & 3 == 0 {
            u32::from(extreme(word)) | u32::from(extreme(word >> 8)) << 16
        } else {
            word
        }
    }

    fn sums(&mut self) -> [ChannelSums<i16>; 2] {
        core::array::from_fn(|_| ChannelSums {
            cosine: self.rough_word() as i32,
            sine: self.rough_word() as i32,
            sum: self.rough_word() as i32,
        })
    }

    fn watch(&mut self) -> [ChannelWatch<i16>; 2] {
        core::array::from_fn(|_| ChannelWatch {
            third_cosine: self.rough_word() as i32,
            third_sine: self.rough_word() as i32,
            low: self.rough_word() as i16,
            high: self.rough_word() as i16,
            runs: (),
        })
    }
}

fn extreme(choice: u32) -> u16 {
    HALVES
        .get(choice as usize % HALVES.len())
        .map_or(0, |&half| half)
}

/// Tries a kernel on two words and a third: all extremes, then random ones.
fn on_words(random: &mut Random, agrees: impl Fn(u32, u32, u32) -> bool) -> bool {
    let extremes = || {
        HALVES
            .iter()
            .flat_map(|&low| HALVES.map(|high| u32::from(low) | u32::from(high) << 16))
    };
    extremes().all(|a| extremes().all(|b| agrees(a, b, a ^ b)))
        && (0..WORDS).all(|_| {
            agrees(
                random.rough_word(),
                random.rough_word(),
                random.rough_word(),
            )
        })
}

/// Tries a kernel on slices of every length, alignment and place in a block, with enough weights or too few.
fn on_slices(
    random: &mut Random,
    mut agrees: impl FnMut(&mut Random, &[[i16; 2]], &[u32], u16) -> bool,
) -> bool {
    let mut pairs = [[0; 2]; MAX_PAIRS + 1];
    let mut weights = [0; 2 * MAX_PAIRS];
    (0..SLICES).all(|_| {
        for pair in &mut pairs {
            let word = random.rough_word();
            *pair = [word as i16, (word >> 16) as i16];
        }
        for weight in &mut weights {
            *weight = random.rough_word();
        }
        let length = random.word() as usize % (MAX_PAIRS + 1);
        // In one case of four the slice begins a block.
        let index = random.word() % MAX_PAIRS as u32;
        let index = if random.word() & 3 == 0 { 0 } else { index };
        let known = 2 * (random.word() as usize % (MAX_PAIRS + 1));
        let enough = (index as usize + length).next_multiple_of(2);
        let known = if random.word() & 3 == 0 {
            known
        } else {
            enough
        };
        // Pairs need not be aligned to words.
        let odd = random.word() as usize & 1;
        let halves = pairs.as_flattened().get(odd..).unwrap_or(&[]);
        match (halves.as_chunks().0.get(..length), weights.get(..known)) {
            (Some(pairs), Some(weights)) => agrees(random, pairs, weights, index as u16),
            _ => false,
        }
    })
}

/// True if the instruction and its twin give the same root.
fn same_root(bits: u32) -> bool {
    let x = f32::from_bits(bits);
    let (root, twin) = (arch::square_root(x), portable::square_root(x));
    // The payload of a NaN is left open by IEEE 754.
    root.to_bits() == twin.to_bits() || root.is_nan() && twin.is_nan()
}

fn same_sums(
    random: &mut Random,
    pairs: &[impl SamplePair<i16>],
    weights: &[u32],
    index: u16,
) -> bool {
    let mut sums = random.sums();
    let mut twin = sums;
    arch::add_pairs(&mut sums, pairs, weights, index);
    portable::add_pairs(&mut twin, pairs, weights, index);
    sums == twin
}

/// Compares sums and watches in f32, of codes, of floats, and of floats with an extreme one.
fn add_floats(random: &mut Random, codes: &[[i16; 2]], weights: &[u32], index: u16) -> bool {
    let small = |word: u32| word as i32 as f32 / 2_147_483_648.0;
    let mut factors = [[0.0; 2]; 2 * MAX_PAIRS];
    for (factor, &word) in factors.iter_mut().zip(weights) {
        *factor = [small(word), small(word.rotate_left(16))];
    }
    let mut floats = [[0.0; 2]; MAX_PAIRS];
    for (float, code) in floats.iter_mut().zip(codes) {
        *float = code.map(|code| small(random.word()) * f32::from(code));
    }
    let sums = random.sums().map(|sums| ChannelSums::<f32> {
        cosine: small(sums.cosine as u32),
        sine: small(sums.sine as u32),
        sum: small(sums.sum as u32),
    });
    let factors = factors.get(..weights.len()).unwrap_or(&[]);
    let mut rough = floats;
    if let Some(pair) = rough.get_mut(random.word() as usize % MAX_PAIRS) {
        let any = FLOATS.get(random.word() as usize % FLOATS.len());
        *pair = [f32::from_bits(*any.unwrap_or(&0)), pair[0]];
    }
    let floats = floats.get(..codes.len()).unwrap_or(&[]);
    let rough = rough.get(..codes.len()).unwrap_or(&[]);
    same_floats(sums, codes, factors, index)
        && same_floats(sums, floats, factors, index)
        && same_watch(random, codes, factors, index)
        && same_watch(random, floats, factors, index)
        && same_watch(random, rough, factors, index)
}

/// Compares watches of pairs between other ones, which in half of the cases are so coarse that many equal those before.
fn same_watch(
    random: &mut Random,
    pairs: &[impl SamplePair<f32>],
    weights: &[[f32; 2]],
    index: u16,
) -> bool {
    let kept = if random.word() & 1 == 0 {
        !0
    } else {
        0x8001_0003
    };
    let mut coarse = [[0; 2]; MAX_PAIRS];
    for coarse in &mut coarse {
        let word = random.rough_word() & kept;
        *coarse = [word as i16, (word >> 16) as i16];
    }
    let coarse = coarse.get(..pairs.len()).unwrap_or(&[]);
    let mut state = ([ChannelSums::empty(); 2], [ChannelWatch::empty(); 2]);
    portable::watch_floats(&mut state.0, &mut state.1, coarse, weights, 0);
    let mut twin = state;
    arch::watch_floats(&mut state.0, &mut state.1, pairs, weights, index);
    portable::watch_floats(&mut twin.0, &mut twin.1, pairs, weights, index);
    arch::watch_floats(&mut state.0, &mut state.1, coarse, weights, index);
    portable::watch_floats(&mut twin.0, &mut twin.1, coarse, weights, index);
    // The payload of a NaN is left open by IEEE 754.
    let bits = |x: f32| if x.is_nan() { 0 } else { x.to_bits() };
    let all = |(sums, watch): ([ChannelSums<f32>; 2], [ChannelWatch<f32>; 2])| {
        (
            sums.map(|sums| [sums.cosine, sums.sine, sums.sum].map(bits)),
            watch.map(|watch| [watch.third_cosine, watch.third_sine].map(bits)),
            watch.map(|watch| [watch.low, watch.high, watch.last()].map(bits)),
            watch.map(|watch| watch.longest()),
        )
    };
    all(state) == all(twin)
}

fn same_floats(
    sums: [ChannelSums<f32>; 2],
    pairs: &[impl SamplePair<f32>],
    weights: &[[f32; 2]],
    index: u16,
) -> bool {
    let (mut sums, mut twin) = (sums, sums);
    arch::add_floats(&mut sums, pairs, weights, index);
    portable::add_floats(&mut twin, pairs, weights, index);
    let bits = |sums: [ChannelSums<f32>; 2]| {
        sums.map(|sums| [sums.cosine, sums.sine, sums.sum].map(f32::to_bits))
    };
    bits(sums) == bits(twin)
}

fn same_watch_of_codes(
    random: &mut Random,
    pairs: &[impl SamplePair<i16>],
    weights: &[u32],
    index: u16,
) -> bool {
    let mut watch = random.watch();
    let mut twin = watch;
    arch::watch_pairs(&mut watch, pairs, weights, index);
    portable::watch_pairs(&mut twin, pairs, weights, index);
    watch == twin
}

#[entry]
fn main() -> ! {
    let random = &mut Random(0x1234_5678);
    let checks = [
        (
            "dual_multiply_add",
            on_words(random, |a, b, sum| {
                arch::dual_multiply_add(a, b, sum) == portable::dual_multiply_add(a, b, sum)
            }),
        ),
        (
            "half_difference",
            on_words(random, |a, b, _| {
                arch::half_difference(a, b) == portable::half_difference(a, b)
            }),
        ),
        (
            "half_sum",
            on_words(random, |a, b, _| {
                arch::half_sum(a, b) == portable::half_sum(a, b)
            }),
        ),
        (
            "limited_difference",
            on_words(random, |a, b, _| {
                arch::limited_difference(a, b) == portable::limited_difference(a, b)
            }),
        ),
        (
            "add_products",
            on_words(random, |a, b, sum| {
                let sum = (i64::from(sum) << 31) ^ i64::from(a as i32);
                let sums = [sum, !sum, i64::from(sum as i32)];
                arch::add_products(sums, a, b) == portable::add_products(sums, a, b)
            }),
        ),
        (
            "add_delayed",
            on_words(random, |a, b, sum| {
                let sums = [
                    (i64::from(sum) << 31) ^ i64::from(a as i32),
                    i64::from(!sum as i32),
                ];
                arch::add_delayed(sums, a, b) == portable::add_delayed(sums, a, b)
            }),
        ),
        (
            "square_root",
            FLOATS.iter().all(|&bits| same_root(bits))
                && (0..WORDS).all(|_| same_root(random.word())),
        ),
        ("add_pairs", on_slices(random, same_sums)),
        ("add_floats", on_slices(random, add_floats)),
        ("watch_pairs", on_slices(random, same_watch_of_codes)),
    ];
    let mut good = true;
    for (kernel, agrees) in checks {
        let mut line = TextLine::new();
        line.text("check_arch ");
        line.text(kernel);
        line.text(if agrees {
            ": as its twin"
        } else {
            ": NOT as its portable twin"
        });
        line.print();
        good &= agrees;
    }
    if good { marks::leave() } else { marks::fail() }
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    marks::fail()
}

//! Instructions per sample pair in Rust, where C would call a `_push_block` function: samples come in half-buffers of a tracked wave, and
//! blocks go to a queue. The tracker that empties it is not counted. `tests/c/push_block.c` of `antinode-capi` is the same in C.
//!
//! In QEMU with `-icount shift=0,align=off,sleep=off` every instruction takes 1 ns, and SysTick counts at the core's 168 MHz.
#![no_std]
#![no_main]

use core::ops::Range;

use antinode::{Block, Front, Packed, Sample, SamplePair, Settings, Tracker};
use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_rt::entry;
use cortex_m_semihosting::hprintln;
use firmware::codes::{Codes, HALF_BUFFER, RING};
use firmware::marks;
use heapless::spsc::Queue;

/// Pairs before the measurement.
const WARM_UP: usize = 2_000;
/// Pairs of the measurement.
const PAIRS: usize = 16_384;

/// The interrupt's work: it turns samples into queued blocks.
#[inline(never)]
fn interrupt<S: Sample, P: SamplePair<S>>(
    front: &mut Front<S, 200>,
    queue: &mut Queue<Block<S>, 16>,
    pairs: &[P],
) -> bool {
    let mut room = true;
    front.extend(pairs, |block| room &= queue.enqueue(*block).is_ok());
    room
}

/// The same from two arrays, in one call per pair: `extend_separate`, which takes 19 to 69 instructions, would share code with interleaved
/// pairs, and neither would be as in an image that needs only one of them.
#[inline(never)]
fn interrupt_separate<S: Sample>(
    front: &mut Front<S, 200>,
    queue: &mut Queue<Block<S>, 16>,
    (c, d): (&[S], &[S]),
) -> bool {
    let mut room = true;
    for (&c, &d) in c.iter().zip(d) {
        if let Some(block) = front.push([c, d]) {
            room &= queue.enqueue(*block).is_ok();
        }
    }
    room
}

/// Prints the instructions per pair that `interrupt` takes; its last argument is a range of the ring.
fn measure<S: Sample>(
    name: [&str; 2],
    watch: bool,
    interrupt: impl Fn(&mut Front<S, 200>, &mut Queue<Block<S>, 16>, Range<usize>) -> bool,
) {
    let mut settings = Settings::new(100e3);
    settings.watch = watch;
    let (Ok(mut front), Ok(mut tracker)) = (Front::new(settings), Tracker::<52>::new(settings))
    else {
        marks::leave()
    };
    let mut queue = Queue::new();
    let mut run = |mut at: usize, to: usize| {
        let mut ticks = 0u32;
        while at < to {
            let from = at % RING;
            let pairs = from..RING.min(from + HALF_BUFFER.min(to - at));
            let count = pairs.len();
            let begin = SYST::get_current();
            interrupt(&mut front, &mut queue, pairs);
            ticks += begin.wrapping_sub(SYST::get_current()) & 0xff_ffff;
            while let Some(block) = queue.dequeue() {
                let _ = tracker.push(&block);
            }
            at += count;
        }
        ticks
    };
    run(0, WARM_UP);
    let ticks = u64::from(run(WARM_UP, WARM_UP + PAIRS));
    let thousandths = ticks * 1_000_000 / 168 / PAIRS as u64;
    let [arithmetic, form] = name;
    let watch = if watch { "watch" } else { "plain" };
    let (whole, rest) = (thousandths / 1000, thousandths % 1000);
    hprintln!("{} {} {} {}.{:03}", arithmetic, watch, form, whole, rest);
}

/// Measures every form of the codes, without and with the watch.
fn all<S: Sample>(arithmetic: &str, codes: &[Packed])
where
    Packed: SamplePair<S>,
{
    let mut pairs = [[S::EXTREMES[0]; 2]; RING];
    let [mut c, mut d] = [[S::EXTREMES[0]; RING]; 2];
    for (i, code) in codes.iter().take(RING).enumerate() {
        pairs[i] = code.pair();
        [c[i], d[i]] = pairs[i];
    }
    for watch in [false, true] {
        measure([arithmetic, "packed"], watch, |front, queue, range| {
            interrupt(front, queue, codes.get(range).unwrap_or(&[]))
        });
        measure([arithmetic, "interleaved"], watch, |front, queue, range| {
            interrupt(front, queue, pairs.get(range).unwrap_or(&[]))
        });
        measure([arithmetic, "separate"], watch, |front, queue, range| {
            interrupt_separate(front, queue, (&c[range.clone()], &d[range]))
        });
    }
}

#[entry]
fn main() -> ! {
    let codes = Codes::new();
    let codes = codes.slice(0, RING);
    let Some(peripherals) = cortex_m::Peripherals::take() else {
        marks::leave()
    };
    let mut systick = peripherals.SYST;
    systick.set_clock_source(SystClkSource::Core);
    systick.set_reload(0xff_ffff);
    systick.clear_current();
    systick.enable_counter();
    all::<i16>("fixed", codes);
    all::<f32>("float", codes);
    marks::leave()
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    marks::leave()
}

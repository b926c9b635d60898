//! Register writes of the images for boards at their start, as logged by the emulator for those that it lacks: ports and DMA.
//!
//! The emulated crystal is dead, so they get as far as the line. A register that it lacks reads as 0: each change shows only its own bits.

use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};
use std::{fs, thread};

use crate::emulator::{Emulator, folder};

/// Offsets in a port: MODER, OSPEEDR, PUPDR, BSRR, AFRL, AFRH.
const MODE: u32 = 0x00;
const SPEED: u32 = 0x08;
const PULL: u32 = 0x0C;
const SET: u32 = 0x18;
const LOW: u32 = 0x20;
const HIGH: u32 = 0x24;
/// Offset in DMA2 of stream 5's registers, at which CR, NDTR, PAR and M0AR follow.
const STREAM_5: u32 = 0x10 + 5 * 0x18;

/// Offset and value of each write to a device, in order.
fn writes(log: &str, device: &str) -> Vec<(u32, u32)> {
    let number = |line: &str, before: &str| {
        let digits = line.split_once(before)?.1.split([',', ')']).next()?;
        u32::from_str_radix(digits, 16).ok()
    };
    log.lines()
        .filter(|line| line.starts_with(device) && line.contains("device write"))
        .filter(|line| line.ends_with(')'))
        .filter_map(|line| Some((number(line, "offset 0x")?, number(line, "value 0x")?)))
        .collect()
}

/// Writes of an image to port A and to DMA2, until it has enabled the line's reception.
fn start(image: &str) -> [Vec<(u32, u32)>; 2] {
    static NEXT: AtomicU32 = AtomicU32::new(0);
    let number = NEXT.fetch_add(1, Ordering::Relaxed);
    let log = folder().join(format!("{number}.registers"));
    let _ = fs::remove_file(&log);
    let _emulator = Emulator::begin(
        Emulator::of(image)
            .args(["-serial", "null", "-d", "unimp", "-D"])
            .arg(&log),
    );
    let began = Instant::now();
    loop {
        assert!(
            began.elapsed() < Duration::from_secs(60),
            "{image}: no line"
        );
        thread::sleep(Duration::from_millis(100));
        let log = fs::read_to_string(&log).unwrap_or_default();
        let dma = writes(&log, "DMA2:");
        if dma.contains(&(STREAM_5, 1)) {
            return [writes(&log, "GPIOA:"), dma];
        }
    }
}

#[test]
#[ignore = "needs the ARM target"]
fn pins_are_set_as_wiring_md_says() {
    for image in ["stm32f405", "stm32f405_ad7380"] {
        let [port, dma] = start(image);
        // PA9 and PA10 to alternate function 7, PA10 pulled up.
        let line = [
            (HIGH, 0x70),
            (MODE, 2 << 18),
            (HIGH, 0x700),
            (MODE, 2 << 20),
            (PULL, 1 << 20),
        ];
        let sampled = if image == "stm32f405" {
            // PA1 and PA2 analog.
            vec![(MODE, 3 << 2), (MODE, 3 << 4)]
        } else {
            // PA5 to PA7 to alternate function 5, SCK at the highest speed; PA8 an output, at the same speed.
            let data = [5, 6, 7].map(|pin| (LOW, 5 << (4 * pin)));
            let modes = [5, 6, 7].map(|pin| (MODE, 2 << (2 * pin)));
            let rest = [(SPEED, 3 << 10), (MODE, 1 << 16), (SPEED, 3 << 16)];
            [&data[..], &modes, &rest].concat()
        };
        for write in line.iter().chain(&sampled) {
            assert!(port.contains(write), "{image}: {write:x?} in {port:x?}");
        }
        // CHSEL 4, MINC, CIRC; from USART1's data register to memory that the DMA reaches; enabled after all else is set.
        let stream = |register: u32| -> Vec<u32> {
            let of = dma
                .iter()
                .filter(|write| write.0 == STREAM_5 + 4 * register);
            of.map(|write| write.1).collect()
        };
        assert_eq!(stream(0), [4 << 25 | 1 << 10 | 1 << 8, 1], "{image}");
        assert_eq!(stream(2), [0x4001_1004], "{image}");
        assert!((0x2000_0000..0x2002_0000).contains(&stream(3)[0]));
        let last = dma
            .iter()
            .rfind(|write| (STREAM_5..STREAM_5 + 0x18).contains(&write.0));
        assert_eq!(last, Some(&(STREAM_5, 1)), "{image}");
    }
}

#[test]
#[ignore = "needs the ARM target"]
fn chip_select_is_never_low_before_the_first_frame() {
    let [port, _] = start("stm32f405_ad7380");
    let out = port.iter().position(|&write| write == (MODE, 1 << 16));
    let high = port.iter().position(|&write| write == (SET, 1 << 8));
    assert!(high.is_some() && high < out, "{port:x?}");
    assert!(!port.contains(&(SET, 1 << 24)), "{port:x?}");
}

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
/// The write that gives PA9 its alternate function.
const TX: (u32, u32) = (MODE, 2 << 18);

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

/// Log of an image's start, until it has given the line its second pin.
fn start(image: &str) -> String {
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
        if writes(&log, "GPIOA:").contains(&TX) {
            return log;
        }
    }
}

#[test]
#[ignore = "needs the ARM target"]
fn pins_are_set_as_wiring_md_says() {
    for image in ["stm32f405", "stm32f405_ad7380"] {
        let log = start(image);
        let (port, dma) = (writes(&log, "GPIOA:"), writes(&log, "DMA2:"));
        // PA9 and PA10 to alternate function 7, PA10 pulled up.
        let line = [
            (HIGH, 0x70),
            TX,
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
    let port = writes(&start("stm32f405_ad7380"), "GPIOA:");
    let out = port.iter().position(|&write| write == (MODE, 1 << 16));
    let high = port.iter().position(|&write| write == (SET, 1 << 8));
    assert!(high.is_some() && high < out, "{port:x?}");
    assert!(!port.contains(&(SET, 1 << 24)), "{port:x?}");
}

#[test]
#[ignore = "needs the ARM target"]
fn the_pin_of_the_line_is_connected_once_its_usart_is_on() {
    for image in ["stm32f405", "stm32f405_ad7380"] {
        let log = start(image);
        let lines: Vec<&str> = log.lines().collect();
        let place = |device: &str, write: (u32, u32)| {
            let is = |line: &&str| writes(line, device) == [write];
            lines.iter().position(is)
        };
        let (receives, connected) = (place("DMA2:", (STREAM_5, 1)), place("GPIOA:", TX));
        assert!(receives.is_some() && receives < connected, "{image}");
    }
}

#[test]
#[ignore = "needs the ARM target"]
fn the_supply_is_watched_before_the_clock_is_raised() {
    for image in ["stm32f405", "stm32f405_ad7380"] {
        let log = start(image);
        // CR.PLS 6, PVDE.
        assert_eq!(writes(&log, "PWR:"), [(0x00, 6 << 5 | 1 << 4)], "{image}");
        let lines: Vec<&str> = log.lines().collect();
        let place = |of: &dyn Fn(&str) -> bool| lines.iter().position(|line| of(line));
        let watched = place(&|line| line.starts_with("PWR:") && line.contains("read"));
        // ACR: wait states.
        let raised = place(&|line| line.starts_with("Flash") && line.contains("write"));
        assert!(watched.is_some() && watched < raised, "{image}");
    }
}

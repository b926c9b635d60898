//! Prints the Rust core's estimates from the codes that `bare_metal.c` identifies, or writes those codes.
//!
//! `reference codes > codes.bin`; `reference fixed`, `reference float`: one line a window, every number as its bits.

use std::io::{self, Write};

use antinode::{Estimate, Identifier, Packed, Sample, SamplePair, Settings};

#[path = "../../../firmware/src/codes.rs"]
#[allow(dead_code, reason = "the images use more of it")]
mod codes;

/// Sample pairs of the ring, and of the run, as in `bare_metal.c`.
const RING: usize = 1406;
const PAIRS: usize = 20_000;

fn main() -> io::Result<()> {
    let codes = codes::Codes::new();
    match std::env::args().nth(1).as_deref() {
        Some("codes") => {
            let mut out = io::stdout().lock();
            for pair in codes.slice(0, RING) {
                out.write_all(&pair.0.to_le_bytes())?;
            }
            out.flush()
        }
        Some("fixed") => print::<i16>(&codes),
        Some("float") => print::<f32>(&codes),
        _ => Err(io::Error::other("usage: reference codes|fixed|float")),
    }
}

fn print<S: Sample>(codes: &codes::Codes) -> io::Result<()>
where
    Packed: SamplePair<S>,
{
    let mut identifier =
        Identifier::<S, 200, 52>::new(Settings::new(1e5)).map_err(io::Error::other)?;
    let mut at = 0;
    while at < PAIRS {
        let pairs = codes.slice(at, 128.min(PAIRS - at));
        at += pairs.len();
        identifier.extend(pairs, line);
    }
    Ok(())
}

/// As `print_bits` of `bare_metal.c`.
fn line(e: Estimate) {
    print!("{:016x}", e.start);
    for value in [e.time, e.angle, e.frequency] {
        print!(" {:016x}", value.to_bits());
    }
    print!(" {} {:03x}", e.samples, e.flags.bits());
    let [offset_c, offset_d] = e.offsets;
    for value in [
        e.main_amplitude,
        e.quadrature_amplitude,
        e.phase,
        e.angle_rate,
        e.decay_rate,
        offset_c,
        offset_d,
        e.main_amplitude_std,
        e.quadrature_amplitude_std,
        e.angle_std,
        e.phase_std,
        e.frequency_std,
        e.angle_rate_std,
        e.decay_rate_std,
        e.residual_rms,
    ] {
        print!(" {:08x}", value.to_bits());
    }
    println!();
}

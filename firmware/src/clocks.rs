//! Clock frequencies and dividers, without registers, so that they can be tested on the host.

/// Core clock, Hz.
pub const CORE: u32 = 168_000_000;
/// Clock of the peripherals on APB2, Hz: converters, USART1, SPI1.
pub const APB2: u32 = CORE / 2;
/// Clock of the timers on APB1, Hz: twice the bus.
pub const APB1_TIMERS: u32 = CORE / 2;
/// Clock of the timers on APB2, Hz: twice the bus.
pub const APB2_TIMERS: u32 = CORE;
/// Frequency of the internal oscillator, HSI, MHz: within 1 % at 25 °C, several per cent off elsewhere in its range (data sheet).
pub const HSI_MHZ: u32 = 16;

/// The PLL's factors that depend on the oscillator: its frequency is divided by `m`, then multiplied by `n`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pll {
    /// PLLCFGR.PLLM, 2 to 63.
    pub m: u8,
    /// PLLCFGR.PLLN, 50 to 432.
    pub n: u16,
}

/// Factors for 336 MHz from an oscillator of 4 to 26 MHz: via 2 MHz, which gives the least jitter, if that divides it, else via 1 MHz
/// (RM0090, 7.3.2).
pub const fn pll(oscillator_mhz: u32) -> Pll {
    let input_mhz = if oscillator_mhz.is_multiple_of(2) {
        2
    } else {
        1
    };
    Pll {
        m: (oscillator_mhz / input_mhz) as u8,
        n: (2 * CORE / 1_000_000 / input_mhz) as u16,
    }
}

/// USART1's BRR for a baud rate: APB2's clock over the rate, rounded. The register counts sixteenths of a divider to 16 samples a bit.
pub const fn usart_divider(baud: u32) -> u32 {
    (APB2 + baud / 2) / baud
}

/// Error of the baud rate that the divider makes, in magnitude and millionths of the rate.
pub const fn baud_error_ppm(baud: u32) -> u32 {
    let made = APB2 as u64 * 1_000_000 / usart_divider(baud) as u64;
    (made.abs_diff(baud as u64 * 1_000_000) / baud as u64) as u32
}

/// Time to send `bytes` bytes at a baud rate, in ten bits each, ms, rounded up.
pub const fn sending_ms(bytes: usize, baud: u32) -> u32 {
    (bytes as u64 * 10_000).div_ceil(baud as u64) as u32
}

/// Longest time, ms, that a restart may wait for an outbox of `outbox` bytes, in which its acknowledgement is last: a dead line must not
/// delay it for ever.
pub const fn restart_ms(outbox: usize, baud: u32) -> u32 {
    let twice = 2 * sending_ms(outbox, baud);
    if twice < 100 { 100 } else { twice }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_oscillator_makes_the_core_clock_within_the_limits_of_the_pll() {
        for mhz in 4..=26 {
            let Pll { m, n } = pll(mhz);
            let (m, n) = (u32::from(m), u32::from(n));
            assert!(
                (2..=63).contains(&m) && (50..=432).contains(&n),
                "{mhz} MHz"
            );
            let input = mhz / m;
            assert_eq!(mhz % m, 0);
            assert_eq!(input, if mhz % 2 == 0 { 2 } else { 1 }, "{mhz} MHz");
            // 336 MHz within the PLL: divided by 2 for the core, by 7 for peripherals at 48 MHz.
            assert_eq!(input * n, 336, "{mhz} MHz");
        }
        assert_eq!(336 / 2 * 1_000_000, CORE);
    }

    #[test]
    fn buses_are_within_the_data_sheet() {
        // RM0090, 7.2: APB1 42 MHz, APB2 84 MHz. The timers have twice their bus.
        let max = (42_000_000, 84_000_000);
        assert!(APB1_TIMERS / 2 <= max.0 && APB2 <= max.1 && APB2_TIMERS == 2 * APB2);
    }

    #[test]
    fn usual_baud_rates_are_met() {
        // A receiver tolerates 3 % and more (RM0090, 30.3.5), part of which the other end may use up.
        for (baud, divider, max) in [
            (115_200, 729, 300),
            (460_800, 182, 1700),
            (921_600, 91, 1700),
            (1_000_000, 84, 0),
            (2_000_000, 42, 0),
            (3_000_000, 28, 0),
        ] {
            assert_eq!(usart_divider(baud), divider);
            assert!(
                baud_error_ppm(baud) <= max,
                "{baud}: {}",
                baud_error_ppm(baud)
            );
        }
        assert!(baud_error_ppm(5_000_000) > 10_000);
    }

    #[test]
    fn a_restart_waits_until_a_full_outbox_is_sent() {
        assert_eq!(sending_ms(2048, 921_600), 23);
        assert_eq!(sending_ms(2048, 115_200), 178);
        for baud in [9600, 115_200, 921_600, 5_250_000] {
            assert!(restart_ms(2048, baud) >= 2 * sending_ms(2048, baud));
        }
        assert_eq!(restart_ms(2048, 115_200), 356);
        assert_eq!(restart_ms(2048, 921_600), 100);
    }
}

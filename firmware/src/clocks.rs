//! The clocks' frequencies and what is divided from them, without registers: tested on the host.

/// Core clock, Hz.
pub const CORE: u32 = 168_000_000;
/// Clock of the peripherals on APB2, Hz: converters, USART1, SPI1.
pub const APB2: u32 = CORE / 2;
/// Clock of the timers on APB1, Hz: twice the bus.
pub const APB1_TIMERS: u32 = CORE / 2;
/// Clock of the timers on APB2, Hz: twice the bus.
pub const APB2_TIMERS: u32 = CORE;
/// Frequency of the chip's own oscillator, MHz: within a percent at 25 °C, several off elsewhere in its range (data sheet, HSI).
pub const HSI_MHZ: u32 = 16;

/// The PLL's factors that vary: what it divides an oscillator by, and what it multiplies that with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pll {
    /// PLLCFGR.PLLM, 2 to 63.
    pub m: u8,
    /// PLLCFGR.PLLN, 50 to 432.
    pub n: u16,
}

/// The factors that make 336 MHz of an oscillator of 4 to 26 MHz: by way of 2 MHz, which jitters least, where that divides it, else of
/// 1 MHz (RM0090, 7.3.2).
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

/// USART1's BRR: the divider in sixteenths of 16 samples a bit, that is APB2's clock over the baud rate, rounded.
pub const fn usart_divider(baud: u32) -> u32 {
    (APB2 + baud / 2) / baud
}

/// What the divider makes of a baud rate, less that rate, in its millionths.
pub const fn baud_error_ppm(baud: u32) -> u32 {
    let made = APB2 as u64 * 1_000_000 / usart_divider(baud) as u64;
    (made.abs_diff(baud as u64 * 1_000_000) / baud as u64) as u32
}

/// How long the line takes for so many bytes at a baud rate, ms, in ten bits each.
pub const fn sending_ms(bytes: usize, baud: u32) -> u32 {
    (bytes as u64 * 10_000).div_ceil(baud as u64) as u32
}

/// How long a restart may wait for an outbox of so many bytes, ms: its acknowledgement goes last. At a dead line it waits no longer.
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
            // Within the PLL; divided by 2 for the core, by 7 for what wants 48 MHz.
            assert_eq!(input * n, 336, "{mhz} MHz");
        }
        assert_eq!(336 / 2 * 1_000_000, CORE);
    }

    #[test]
    fn buses_are_within_the_data_sheet() {
        // RM0090, 7.2: APB1 42 MHz, APB2 84 MHz. The timers have twice their bus.
        let most = (42_000_000, 84_000_000);
        assert!(APB1_TIMERS / 2 <= most.0 && APB2 <= most.1 && APB2_TIMERS == 2 * APB2);
    }

    #[test]
    fn usual_baud_rates_are_met() {
        // A receiver puts up with 3 % and more (RM0090, 30.3.5), of which the other end has its share.
        for (baud, divider, most) in [
            (115_200, 729, 300),
            (460_800, 182, 1700),
            (921_600, 91, 1700),
            (1_000_000, 84, 0),
            (2_000_000, 42, 0),
            (3_000_000, 28, 0),
        ] {
            assert_eq!(usart_divider(baud), divider);
            assert!(
                baud_error_ppm(baud) <= most,
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

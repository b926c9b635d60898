//! Check for a main amplitude that the mains modulate through a gain or a supply, as distinct from hum that is added to the signals.

use std::f64::consts::TAU;

use antinode::{Estimate, Flags};

/// Rows per spectrum, and fewest rows of a recording that is too short for that.
const SPECTRUM_ROWS: usize = 256;
const MIN_ROWS: usize = 128;
/// Spectra computed per recording, at most.
const MAX_SPECTRA: u32 = 16;
/// Ripple frequencies, Hz: of rectified mains; and of the mains themselves, used with `--hum` only, as hum also adds to the amplitude.
const RECTIFIED: [f64; 2] = [100.0, 120.0];
const MAINS: [f64; 2] = [50.0, 60.0];
/// Ratio of a line's amplitude to that of any other, at least; in noise alone one of 2⁷ lines has 5 in e⁻¹⁰⁰ of all cases.
const LINE_RATIO: f64 = 5.0;
/// Smallest ripple reported, as a share of the amplitude.
const MIN_RIPPLE: f64 = 5e-4;
/// Periods of the ripple that the suggested window holds.
const WINDOW_RIPPLES: f64 = 3.2;
/// Lines of a spectrum on either side of a tone that belong to it, and lowest lines that belong to a ring-down.
const LINE_WIDTH: f64 = 4.0;
const SKIPPED_LOW_LINES: usize = 8;

/// The rows of the current spectrum, and what was seen in those before.
#[derive(Debug, Default)]
pub(super) struct MainsRipple {
    hum: bool,
    /// Times, s, and main amplitudes.
    rows: Vec<[f64; 2]>,
    end: u64,
    spectra: u32,
    /// Spectra in which a line was seen, and the first line, Hz, with its share of the amplitude.
    seen: u32,
    first: Option<[f64; 2]>,
    /// The wave's frequency, Hz.
    frequency: f64,
}

impl MainsRipple {
    /// No rows yet, of an identification with `--hum` or without.
    pub fn new(hum: bool) -> Self {
        Self {
            hum,
            ..Self::default()
        }
    }

    /// Takes a row.
    pub fn see(&mut self, estimate: &Estimate) {
        if self.spectra == MAX_SPECTRA || estimate.start < self.end {
            return;
        }
        if estimate.flags.contains(Flags::LOST) {
            self.rows.clear();
            return;
        }
        (self.end, self.frequency) = (estimate.end(), estimate.frequency);
        self.rows
            .push([estimate.time, estimate.main_amplitude.into()]);
        if self.rows.len() == SPECTRUM_ROWS {
            self.examine();
        }
    }

    fn examine(&mut self) {
        let lines: Vec<f64> = if self.hum {
            [RECTIFIED, MAINS].concat()
        } else {
            RECTIFIED.to_vec()
        };
        self.spectra += 1;
        if let Some(line) = line(&self.rows, &lines) {
            self.first.get_or_insert(line);
            self.seen += 1;
        }
        self.rows.clear();
    }

    /// A warning if most spectra show a line.
    pub fn warning(&mut self) -> Option<String> {
        if self.spectra == 0 && self.rows.len() >= MIN_ROWS {
            self.examine();
        }
        let [line, share] = self.first?;
        let periods = (WINDOW_RIPPLES * self.frequency / line).ceil();
        (2 * self.seen > self.spectra).then(|| {
            format!(
                "the main amplitude oscillates by {:.2} % at {line} Hz: there is mains ripple on a gain or a supply, or a second tone {line} \
                 Hz from the wave; remove the cause, or give --coloured and --periods {periods}, so that a window holds several ripples",
                100.0 * share
            )
        })
    }
}

/// That of these lines, Hz, that stands out of the spectrum of the rows, with its amplitude over the mean.
fn line(rows: &[[f64; 2]], lines: &[f64]) -> Option<[f64; 2]> {
    let count = rows.len() as f64;
    let (first, last) = (rows.first()?[0], rows.last()?[0]);
    let apart = (last - first) / (count - 1.0);
    let bin = 1.0 / (count * apart);
    let mean = rows.iter().map(|row| row[1]).sum::<f64>() / count;
    // Hann's window confines a ring-down to the lowest few lines.
    let weighted: Vec<[f64; 2]> = rows
        .iter()
        .map(|&[time, value]| {
            let place = (time - first) / apart + 0.5;
            let weight = 1.0 - (TAU * place / count).cos();
            [time - first, weight * (value / mean - 1.0)]
        })
        .collect();
    let amplitude = |frequency: f64| {
        let parts = weighted.iter().map(|[time, value]| {
            let (sin, cos) = (TAU * frequency * time).sin_cos();
            [value * cos, value * sin]
        });
        let [c, s] = parts.fold([0.0; 2], |sums, part| {
            [sums[0] + part[0], sums[1] + part[1]]
        });
        2.0 * f64::hypot(c, s) / count
    };
    // Lines that the rows resolve, and that are no part of the ring-down.
    let is_within = |line: &f64| (2.0 * LINE_WIDTH * bin..0.45 / apart).contains(line);
    let own = lines.iter().copied().filter(is_within);
    let own = own.map(|line| [line, amplitude(line)]);
    let largest = own.max_by(|one, other| one[1].total_cmp(&other[1]))?;
    let others = (SKIPPED_LOW_LINES..rows.len() / 2).map(|k| k as f64 * bin);
    let mut others = others.filter(|other| (other - largest[0]).abs() > LINE_WIDTH * bin);
    (largest[1] > MIN_RIPPLE && others.all(|other| largest[1] > LINE_RATIO * amplitude(other)))
        .then_some(largest)
}

#[cfg(test)]
mod tests {
    use super::super::row_scatter::tests::row;
    use super::*;
    use antinode_sim::Deviates;

    /// The warning for this many rows, each first changed according to its time.
    fn warning(hum: bool, count: u64, change: impl Fn(f32, &mut Estimate)) -> Option<String> {
        let (mut ripple, mut deviates) = (MainsRipple::new(hum), Deviates::new(5));
        for index in 0..count {
            let mut row = row(index, 1.0, &mut deviates);
            change(row.time as f32, &mut row);
            ripple.see(&row);
        }
        ripple.warning()
    }

    /// A ring-down with a ripple of 0.6 % at this frequency, Hz.
    fn rippled(frequency: f32) -> impl Fn(f32, &mut Estimate) {
        rippled_by(0.006, frequency)
    }

    /// A ring-down with a ripple of this share.
    fn rippled_by(share: f32, frequency: f32) -> impl Fn(f32, &mut Estimate) {
        move |time, row| {
            let ripple = 1.0 + share * (TAU as f32 * frequency * time + 1.0).cos();
            row.main_amplitude *= ripple * (-time).exp();
        }
    }

    #[test]
    fn a_ripple_of_the_mains_raises_a_warning() {
        for (frequency, hum, is_told) in [
            (100.0, false, true),
            (120.0, false, true),
            (100.3, false, true),
            (110.0, false, false),
            (90.0, true, false),
            (60.0, true, true),
            (50.0, true, true),
            // Without the option, this may be additive hum.
            (50.0, false, false),
        ] {
            for count in [140, 256, 3000] {
                let warning = warning(hum, count, rippled(frequency));
                assert_eq!(
                    warning.is_some(),
                    is_told,
                    "{frequency} {count}: {warning:?}"
                );
                let Some(warning) = warning else { continue };
                let share = warning
                    .split(" by ")
                    .nth(1)
                    .unwrap()
                    .split(' ')
                    .next()
                    .unwrap();
                let share: f64 = share.parse().unwrap();
                assert!((share - 0.6).abs() < 0.03, "{frequency} {count}: {warning}");
                // Three ripples of a wave of 5332 Hz.
                let periods = if frequency < 90.0 {
                    3.2 * 5332.0 / frequency
                } else {
                    171.0
                };
                let told = format!("--periods {}, so", periods.ceil());
                assert!(frequency > 110.0 || warning.contains(&told), "{warning}");
            }
        }
    }

    #[test]
    fn rows_of_overlapping_windows_and_of_several_ring_downs_show_a_ripple() {
        let overlapping = |_: f32, row: &mut Estimate| {
            row.start /= 10;
            row.time = (row.start + 100) as f64 / 1e5;
            rippled(100.0)(row.time as f32, row);
        };
        assert!(warning(false, 3000, overlapping).is_some());
        let several = |time: f32, row: &mut Estimate| {
            rippled(100.0)(time, row);
            let index = row.start / 200;
            if index % 400 < 5 {
                row.flags = Flags::LOST;
            }
            if index % 800 < 400 {
                row.main_amplitude *= 0.2;
            }
        };
        assert!(warning(false, 3000, several).is_some());
    }

    #[test]
    fn noise_and_other_tones_raise_no_warning() {
        assert_eq!(warning(true, 3000, |_, _| ()), None);
        assert_eq!(warning(true, 100, rippled(100.0)), None);
        // A second line as large as that of the mains.
        let beat = |time: f32, row: &mut Estimate| {
            rippled(100.0)(time, row);
            rippled(171.0)(time, row);
        };
        assert_eq!(warning(true, 3000, beat), None);
        let beside_less = |time: f32, row: &mut Estimate| {
            rippled(100.0)(time, row);
            rippled_by(0.002, 171.0)(time, row);
        };
        assert_eq!(warning(true, 3000, beside_less), None);
        // Too small to matter, even without noise and decay.
        for (share, is_told) in [(4e-4, false), (6e-4, true)] {
            let small = |time: f32, row: &mut Estimate| {
                row.main_amplitude = 0.6 * time.exp();
                rippled_by(share, 100.0)(time, row);
            };
            assert_eq!(warning(true, 3000, small).is_some(), is_told, "{share}");
        }
        let once = |time: f32, row: &mut Estimate| {
            if time < 0.5 {
                rippled(100.0)(time, row);
            }
        };
        assert_eq!(warning(true, 3000, once), None);
    }
}

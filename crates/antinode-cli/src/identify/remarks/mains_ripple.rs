//! Whether the main amplitude goes up and down with the mains, which ripple on a gain or a supply: hum that is added does not.

use std::f64::consts::TAU;

use antinode::{Estimate, Flags};

/// Rows looked at together, and the fewest at the end of a recording.
const ROWS: usize = 256;
const FEWEST: usize = 128;
/// So many times such rows are looked at.
const MOST: u32 = 16;
/// What ripples, Hz: the rectified mains, and the mains themselves, whose hum adds to the amplitude too.
const RECTIFIED: [f64; 2] = [100.0, 120.0];
const MAINS: [f64; 2] = [50.0, 60.0];
/// How far a line stands out of all others, as amplitudes; in noise alone of 2⁷ lines one does by 5 times in e⁻¹⁰⁰ of all cases.
const OUT: f64 = 5.0;
/// No smaller ripple is told, as a share of the amplitude.
const LEAST: f64 = 5e-4;
/// Ripples that a window is to hold.
const RIPPLES: f64 = 3.2;
/// Lines of a spectrum that a tone takes, and those that a ring-down does.
const WIDE: f64 = 4.0;
const SLOW: usize = 8;

/// Rows that are looked at, and what was seen.
#[derive(Debug, Default)]
pub(super) struct MainsRipple {
    hum: bool,
    /// Times and amplitudes.
    rows: Vec<[f64; 2]>,
    end: u64,
    looks: u32,
    /// How often a line was seen, and the first of them with its share of the amplitude.
    seen: u32,
    first: [f64; 2],
    /// The wave's frequency, Hz.
    frequency: f64,
}

impl MainsRipple {
    /// None yet, of an identification with `--hum` or without.
    pub fn new(hum: bool) -> Self {
        Self {
            hum,
            ..Self::default()
        }
    }

    /// Takes a row.
    pub fn see(&mut self, estimate: &Estimate) {
        if self.looks == MOST || estimate.start < self.end {
            return;
        }
        if estimate.flags.contains(Flags::LOST) {
            self.rows.clear();
            return;
        }
        (self.end, self.frequency) = (estimate.end(), estimate.frequency);
        self.rows
            .push([estimate.time, estimate.main_amplitude.into()]);
        if self.rows.len() == ROWS {
            self.look();
        }
    }

    fn look(&mut self) {
        let lines: Vec<f64> = if self.hum {
            [RECTIFIED, MAINS].concat()
        } else {
            RECTIFIED.to_vec()
        };
        self.looks += 1;
        if let Some(line) = line(&self.rows, &lines) {
            if self.seen == 0 {
                self.first = line;
            }
            self.seen += 1;
        }
        self.rows.clear();
    }

    /// What to tell where most looks saw a line.
    pub fn told(&mut self) -> Option<String> {
        if self.looks == 0 && self.rows.len() >= FEWEST {
            self.look();
        }
        let [line, share] = self.first;
        let periods = (RIPPLES * self.frequency / line).ceil();
        (2 * self.seen > self.looks).then(|| {
            format!(
                "the main amplitude goes up and down by {:.2} % at {line} Hz: mains ripple on a gain or a supply, or a second tone is so far from \
                 the wave; mend that, or give --coloured and --periods {periods}, which holds several such ripples",
                100.0 * share
            )
        })
    }
}

/// The only one of these lines, Hz, that stands out of the spectrum of rows, with its amplitude over the mean.
fn line(rows: &[[f64; 2]], lines: &[f64]) -> Option<[f64; 2]> {
    let count = rows.len() as f64;
    let (first, last) = (rows.first()?[0], rows.last()?[0]);
    let apart = (last - first) / (count - 1.0);
    let bin = 1.0 / (count * apart);
    let mean = rows.iter().map(|row| row[1]).sum::<f64>() / count;
    // By Hann's window nothing is left of a ring-down a few lines on.
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
    // Those that the rows tell, and that are no part of the ring-down.
    let is_within = |line: &f64| (2.0 * WIDE * bin..0.45 / apart).contains(line);
    let own = lines.iter().copied().filter(is_within);
    let own = own.map(|line| [line, amplitude(line)]);
    let largest = own.max_by(|one, other| one[1].total_cmp(&other[1]))?;
    let others = (SLOW..rows.len() / 2).map(|k| k as f64 * bin);
    let mut others = others.filter(|other| (other - largest[0]).abs() > WIDE * bin);
    (largest[1] > LEAST && others.all(|other| largest[1] > OUT * amplitude(other)))
        .then_some(largest)
}

#[cfg(test)]
mod tests {
    use super::super::row_scatter::tests::row;
    use super::*;
    use crate::deviates::Deviates;

    /// What is told of so many rows, each first changed by its time.
    fn told(hum: bool, count: u64, change: impl Fn(f32, &mut Estimate)) -> Option<String> {
        let (mut ripple, mut deviates) = (MainsRipple::new(hum), Deviates(5));
        for index in 0..count {
            let mut row = row(index, 1.0, &mut deviates);
            change(row.time as f32, &mut row);
            ripple.see(&row);
        }
        ripple.told()
    }

    /// A ring-down with a ripple of 0.6 % at this frequency, Hz.
    fn rippled(frequency: f32) -> impl Fn(f32, &mut Estimate) {
        move |time, row| {
            let ripple = 1.0 + 0.006 * (TAU as f32 * frequency * time + 1.0).cos();
            row.main_amplitude *= ripple * (-time).exp();
        }
    }

    #[test]
    fn a_ripple_of_the_mains_is_told() {
        for (frequency, hum, is_told) in [
            (100.0, false, true),
            (120.0, false, true),
            (100.3, false, true),
            (110.0, false, false),
            (90.0, true, false),
            (60.0, true, true),
            (50.0, true, true),
            // Without the option, hum may be no gain's.
            (50.0, false, false),
        ] {
            for count in [140, 256, 3000] {
                let told = told(hum, count, rippled(frequency));
                assert_eq!(told.is_some(), is_told, "{frequency} {count}: {told:?}");
                let Some(told) = told else { continue };
                let share = told
                    .split(" by ")
                    .nth(1)
                    .unwrap()
                    .split(' ')
                    .next()
                    .unwrap();
                let share: f64 = share.parse().unwrap();
                assert!((share - 0.6).abs() < 0.03, "{frequency} {count}: {told}");
            }
        }
    }

    #[test]
    fn noise_and_other_tones_are_none() {
        assert_eq!(told(true, 3000, |_, _| ()), None);
        assert_eq!(told(true, 100, rippled(100.0)), None);
        // A beat, and its share of the mains.
        let beat = |time: f32, row: &mut Estimate| {
            rippled(100.0)(time, row);
            rippled(171.0)(time, row);
        };
        assert_eq!(told(true, 3000, beat), None);
        let once = |time: f32, row: &mut Estimate| {
            if time < 0.5 {
                rippled(100.0)(time, row);
            }
        };
        assert_eq!(told(true, 3000, once), None);
    }
}

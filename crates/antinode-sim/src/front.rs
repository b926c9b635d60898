//! From the resonator to the converter's input: jitter, pick-offs, distortion, gain, offset, hum and noise.

use crate::carrier::Carrier;
use crate::flaws::Flaws;
use crate::noise::{Coloured, Normals, Stream};
use crate::split::SplitWave;
use crate::time::Instant;
use crate::wave::Wave;
use libm::sincos;

/// The converter's input at one sample.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Input {
    /// Wave and floor together.
    pub signal: [f64; 2],
    /// The signal without the wave: offset, hum and noise.
    pub floor: [f64; 2],
}

/// How the clean signals are computed.
#[derive(Debug, Clone)]
enum Source {
    /// By complex rotation: without jitter and frequency drift.
    Steady(Box<Carrier<Wave>>),
    /// The same for a resonator with splits.
    Split(Box<Carrier<SplitWave>>),
    /// By the formulas, in all other cases.
    Formulas { jitter: Option<(f64, Normals)> },
}

/// The analogue part of the gyro; sample `index` is a function of `index` alone.
#[derive(Debug, Clone)]
pub(crate) struct Front {
    wave: Wave,
    sample_rate: f64,
    source: Source,
    skew: f64,
    /// (sin, cos) of the pick-off error in the pattern, 2 eps.
    turn: Option<(f64, f64)>,
    /// Cubic distortion over a^2, 1 / (input unit)^2.
    bend: f64,
    gain: f64,
    offset: [f64; 2],
    /// Amplitude of the hum and its turns a sample.
    hum: Option<(f64, f64)>,
    noise: Option<(f64, Normals)>,
    coloured: Option<(f64, Coloured)>,
}

impl Front {
    pub fn new(wave: Wave, flaws: &Flaws, sample_rate: f64, seed: u64) -> Front {
        let normals = |rms: f64, stream| (rms > 0.0).then(|| (rms, Normals::new(seed, stream)));
        let source = if flaws.jitter > 0.0 || wave.frequency_rate != 0.0 {
            Source::Formulas {
                jitter: normals(flaws.jitter, Stream::Jitter),
            }
        } else if let Some(split) = SplitWave::of(&wave) {
            Source::Split(Box::new(Carrier::new(split, sample_rate, flaws.skew)))
        } else {
            Source::Steady(Box::new(Carrier::new(wave, sample_rate, flaws.skew)))
        };
        Front {
            wave,
            sample_rate,
            source,
            skew: flaws.skew,
            turn: (flaws.pick_off_angle != 0.0).then(|| sincos(2.0 * flaws.pick_off_angle)),
            bend: flaws.cubic / (wave.main_amplitude * wave.main_amplitude),
            gain: flaws.gain_ratio,
            offset: [flaws.offset_c, flaws.offset_d],
            hum: (flaws.hum != 0.0).then(|| (flaws.hum, flaws.hum_frequency / sample_rate)),
            noise: normals(flaws.noise, Stream::Noise),
            coloured: (flaws.coloured_noise > 0.0).then(|| {
                let noise = Coloured::new(seed, flaws.coloured_corner, sample_rate);
                (flaws.coloured_noise, noise)
            }),
        }
    }

    pub fn at(&mut self, index: u64) -> Input {
        let [c, d] = self.pick_offs(index);
        let mut floor = self.offset;
        if let Some((amplitude, turns)) = self.hum {
            let turns = turns * index as f64;
            let hum = amplitude * sincos(core::f64::consts::TAU * (turns - libm::floor(turns))).0;
            floor = floor.map(|s| s + hum);
        }
        if let Some((rms, normals)) = &mut self.noise {
            add(&mut floor, *rms, normals.pair(index));
        }
        if let Some((rms, coloured)) = &mut self.coloured {
            add(&mut floor, *rms, coloured.pair(index));
        }
        let bent = |s: f64| s + self.bend * s * s * s;
        let signal = [bent(c) + floor[0], self.gain * bent(d) + floor[1]];
        Input { signal, floor }
    }

    fn pick_offs(&mut self, index: u64) -> [f64; 2] {
        let ([c, _], [c_late, d_late]) = match &mut self.source {
            Source::Steady(carrier) => carrier.at(index),
            Source::Split(carrier) => carrier.at(index),
            Source::Formulas { jitter } => {
                let mut instant = Instant::of_sample(index, self.sample_rate);
                if let Some((rms, normals)) = jitter {
                    instant = instant.later(*rms * normals.pair(index).0);
                }
                let on_time = self.wave.pick_offs_at(instant);
                let skewed = if self.skew == 0.0 {
                    on_time
                } else {
                    self.wave.pick_offs_at(instant.later(self.skew))
                };
                (on_time, skewed)
            }
        };
        let d = self
            .turn
            .map_or(d_late, |(sin, cos)| d_late * cos - c_late * sin);
        [c, d]
    }
}

/// Adds noise of `rms` to both channels.
fn add(floor: &mut [f64; 2], rms: f64, (c, d): (f64, f64)) {
    floor[0] += rms * c;
    floor[1] += rms * d;
}

#[cfg(test)]
mod tests;

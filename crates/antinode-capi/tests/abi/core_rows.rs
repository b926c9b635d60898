//! The core's rows for the same codes, and their comparison with those of the C ABI.

use antinode::Block;
use antinode_capi::*;

use crate::gyro::{Arithmetic, samples};

pub const RATE: f64 = 1e5;
/// How fast the pattern of [`codes`] turns, rad/s.
pub const TURN: f64 = 1.0;
const RING: usize = ANTINODE_MOST_PERIODS + 2;

pub type Identifier<S> = antinode::Identifier<S, ANTINODE_LONGEST_PERIOD, RING>;
type CoreRow = antinode::Estimate;

/// A wave with noise in 16-bit codes; its pattern turns.
pub fn codes(count: usize, frequency: f64) -> Vec<[i16; 2]> {
    let mut seed = 7u32;
    (0..count)
        .map(|k| {
            let time = k as f64 / RATE;
            let (s, c) = (std::f64::consts::TAU * frequency * time).sin_cos();
            let (s2, c2) = (2.0 * (0.35 + TURN * time)).sin_cos();
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let noise = |shift: u32| f64::from(seed >> shift & 31) - 15.5;
            let (a, b) = (20_000.0 * c, 1_500.0 * s);
            [
                (a * c2 - b * s2 + noise(27) + 300.0) as i16,
                (a * s2 + b * c2 + noise(20) - 200.0) as i16,
            ]
        })
        .collect()
}

/// The core's settings for settings of C, converted independently of the library, so that a field which that leaves out is noticed.
pub fn core_settings(settings: &Settings) -> antinode::Settings {
    antinode::Settings {
        sample_rate: settings.sample_rate_hz,
        periods: settings.periods as u16,
        hop: Some(settings.hop_blocks as u16).filter(|&hop| hop != 0),
        start_angle: settings.start_angle_rad,
        rails: Some([settings.rail_low, settings.rail_high]).filter(|&rails| rails != [0.0; 2]),
        resolution: Some(settings.resolution).filter(|&step| step != 0.0),
        frequency: Some(settings.frequency_hz).filter(|&frequency| frequency != 0.0),
        detection: match settings.detection {
            ANTINODE_DETECTION_MEAN_RETURN => antinode::Detection::MeanReturn,
            _ => antinode::Detection::Difference,
        },
        watch: settings.watch == 1,
        hum: settings.hum == 1,
        coloured: settings.coloured == 1,
        calibration: core_calibration(settings.calibration),
    }
}

pub fn core_calibration(calibration: Calibration) -> antinode::Calibration {
    antinode::Calibration {
        gain_ratio: calibration.gain_ratio,
        skew: calibration.skew_s,
        pick_off_angle: calibration.pick_off_angle_rad,
    }
}

/// All rows of the core for these codes.
pub fn rows<S: Arithmetic>(settings: &Settings, codes: &[[i16; 2]]) -> Vec<CoreRow> {
    let mut identifier = Box::new(Identifier::<S>::new(core_settings(settings)).unwrap());
    let mut all = Vec::new();
    identifier.extend(&samples::<S>(codes), |row| all.push(row));
    all
}

/// The two halves of the core, with access to the blocks between them.
pub struct Halves<S: Arithmetic> {
    pub front: Box<antinode::Front<S, ANTINODE_LONGEST_PERIOD>>,
    pub tracker: Box<antinode::Tracker<RING>>,
}

impl<S: Arithmetic> Halves<S> {
    pub fn new(settings: &Settings) -> Self {
        let settings = core_settings(settings);
        Self {
            front: Box::new(antinode::Front::new(settings).unwrap()),
            tracker: Box::new(antinode::Tracker::new(settings).unwrap()),
        }
    }

    /// The blocks that the pairs finish, after a search if the tracker wants one.
    pub fn blocks(&mut self, codes: &[[i16; 2]]) -> Vec<Block<S>> {
        self.front.search_if_wanted(self.tracker.wanted_search());
        let pairs = samples::<S>(codes);
        pairs
            .into_iter()
            .filter_map(|pair| self.front.push(pair).copied())
            .collect()
    }

    pub fn solve(&mut self, blocks: &[Block<S>]) -> Vec<CoreRow> {
        blocks
            .iter()
            .filter_map(|block| self.tracker.push(block))
            .collect()
    }

    pub fn run(&mut self, codes: &[[i16; 2]]) -> Vec<CoreRow> {
        let blocks = self.blocks(codes);
        self.solve(&blocks)
    }
}

/// Asserts that rows are equal bit for bit.
pub fn same(name: &str, ours: &[Estimate], cores: &[CoreRow]) {
    assert_eq!(ours.len(), cores.len(), "{name}");
    for (our, core) in ours.iter().zip(cores) {
        // Compared as text, so that NaN equals NaN, and 0 differs from −0.
        assert_eq!(
            format!("{:?}", numbers(our)),
            format!("{:?}", core_numbers(core)),
            "{name}"
        );
    }
}

/// Every number of a row; f64 holds each exactly.
fn numbers(row: &Estimate) -> [f64; 22] {
    [
        row.start as f64,
        row.time_s,
        row.angle_rad,
        row.frequency_hz,
        row.samples.into(),
        row.flags.into(),
        row.main_amplitude.into(),
        row.quadrature_amplitude.into(),
        row.phase_rad.into(),
        row.angle_rate_rad_s.into(),
        row.decay_rate_s.into(),
        row.offset_c.into(),
        row.offset_d.into(),
        row.main_amplitude_std.into(),
        row.quadrature_amplitude_std.into(),
        row.angle_std_rad.into(),
        row.phase_std_rad.into(),
        row.frequency_std_hz.into(),
        row.angle_rate_std_rad_s.into(),
        row.decay_rate_std_s.into(),
        row.residual_rms.into(),
        row.reserved.into(),
    ]
}

fn core_numbers(row: &CoreRow) -> [f64; 22] {
    [
        row.start as f64,
        row.time,
        row.angle,
        row.frequency,
        row.samples.into(),
        row.flags.bits().into(),
        row.main_amplitude.into(),
        row.quadrature_amplitude.into(),
        row.phase.into(),
        row.angle_rate.into(),
        row.decay_rate.into(),
        row.offsets[0].into(),
        row.offsets[1].into(),
        row.main_amplitude_std.into(),
        row.quadrature_amplitude_std.into(),
        row.angle_std.into(),
        row.phase_std.into(),
        row.frequency_std.into(),
        row.angle_rate_std.into(),
        row.decay_rate_std.into(),
        row.residual_rms.into(),
        0.0,
    ]
}

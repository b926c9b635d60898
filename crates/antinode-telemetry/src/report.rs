//! Reports from the device to the PC.

use core::fmt;

use antinode::Estimate;
use antinode::methods::comparison::Comparison;
use serde::{Deserialize, Serialize};

use crate::PROTOCOL_VERSION;
use crate::command::CommandError;
use crate::configuration::Configuration;

/// Report from the device to the PC.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Report {
    /// Version and configuration of the device.
    Hello(Hello),
    /// The wave over one window, bit for bit as the core gave it.
    Estimate(Estimate),
    /// A new state of the device.
    State(State),
    /// Counters since the device's start.
    Counters(Counters),
    /// The answer to a command.
    Acknowledgement(Acknowledgement),
    /// The paper's methods over the window of the last estimate.
    Methods(Methods),
}

impl From<Estimate> for Report {
    fn from(estimate: Estimate) -> Self {
        Self::Estimate(estimate)
    }
}

/// Longest firmware version in a [`Hello`], bytes.
pub const FIRMWARE_BYTES: usize = 24;

/// Version and configuration of the device.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Hello {
    /// [`PROTOCOL_VERSION`] of the device.
    pub protocol: u8,
    /// Version of its firmware, such as `0.1.0`.
    pub firmware: heapless::String<FIRMWARE_BYTES>,
    /// Configuration of the device.
    pub configuration: Configuration,
}

impl Hello {
    /// A Hello of this protocol; of `firmware` it keeps the characters that fit.
    pub fn new(firmware: &str, configuration: Configuration) -> Self {
        let mut kept = heapless::String::new();
        let fits = |end: &usize| firmware.is_char_boundary(*end);
        let end = (0..=FIRMWARE_BYTES.min(firmware.len())).rev().find(fits);
        // Never fails, as the length is limited.
        let _ = kept.push_str(firmware.get(..end.unwrap_or(0)).unwrap_or(""));
        Self {
            protocol: PROTOCOL_VERSION,
            firmware: kept,
            configuration,
        }
    }
}

/// State of the device.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum State {
    /// The device has started; the cause is that of its reset.
    Started(Cause),
    /// The device searches for a wave: sent after the start, and when the tracker wants a new search while the last state was `Tracking`.
    Searching,
    /// The device tracks a wave: sent with the first estimate after any other state.
    Tracking,
    /// Sampling was restarted; the time of estimates includes the pairs lost, which [`Counters`] count.
    SamplingRestarted(Cause),
    /// The device has stopped sampling.
    Fault(Cause),
}

/// Why the device restarted or stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Cause {
    /// Power came on.
    PowerOn,
    /// The supply dipped below its limit.
    BrownOut,
    /// The reset pin was pulled.
    ResetPin,
    /// A debug probe reset the chip, or software that left no note.
    Software,
    /// A command asked for it.
    Command,
    /// The watchdog was not fed in time.
    Watchdog,
    /// The firmware panicked.
    Panic,
    /// The processor took a fault, as by an access to an invalid address.
    HardFault,
    /// The converter overran: samples were not fetched in time.
    Overrun,
    /// The DMA reported a transfer error.
    Dma,
    /// The converter does not answer, or not at its rate.
    Converter,
    /// The crystal failed.
    Clock,
    /// None of these.
    Unknown,
}

impl fmt::Display for State {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Started(cause) => write!(f, "started: {cause}"),
            Self::Searching => f.write_str("searching for a wave"),
            Self::Tracking => f.write_str("tracking a wave"),
            Self::SamplingRestarted(cause) => write!(f, "sampling restarted: {cause}"),
            Self::Fault(cause) => write!(f, "fault: {cause}"),
        }
    }
}

impl Cause {
    /// Its name, such as `brown-out`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::PowerOn => "power on",
            Self::BrownOut => "brown-out",
            Self::ResetPin => "reset pin",
            Self::Software => "probe or software reset",
            Self::Command => "command",
            Self::Watchdog => "watchdog",
            Self::Panic => "panic",
            Self::HardFault => "hard fault",
            Self::Overrun => "overrun",
            Self::Dma => "DMA error",
            Self::Converter => "converter",
            Self::Clock => "clock",
            Self::Unknown => "unknown cause",
        }
    }
}

impl fmt::Display for Cause {
    /// Its [`name`](Self::name).
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Counters since the device's start. They wrap.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Counters {
    /// Time since the start, ms.
    pub uptime_ms: u64,
    /// Sample pairs taken.
    pub pairs: u64,
    /// Sample pairs lost.
    pub pairs_lost: u64,
    /// Sample pairs with a sample at the converter's rail.
    pub saturated_pairs: u64,
    /// Blocks with a sample at the converter's rail.
    pub saturated_blocks: u32,
    /// Overruns of the converter.
    pub overruns: u32,
    /// Blocks dropped because the queue to the tracker was full.
    pub blocks_dropped: u32,
    /// Reports dropped because the queue to the USART was full; their numbers are missing.
    pub reports_dropped: u32,
    /// Damaged command frames.
    pub commands_damaged: u32,
    /// Restarts of sampling.
    pub restarts: u32,
}

/// The answer to a command.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Acknowledgement {
    /// The command's id.
    pub id: u16,
    /// Success, or the reason for the refusal.
    pub result: Result<(), CommandError>,
}

/// Result of one of the paper's methods; amplitudes in input units.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct MethodValues {
    /// a_A, ≥ 0.
    pub main_amplitude: f64,
    /// a_B, signed.
    pub quadrature_amplitude: f64,
    /// θ_A, rad, nearest to the estimate's.
    pub angle: f64,
    /// Rank from 1, to be trusted most, to 4.
    pub rank: u8,
}

/// The paper's methods over one window.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Methods {
    /// Index in the stream of the window's first sample pair: that of its [`Estimate`].
    pub start: u64,
    /// Algorithms 1 to 4.
    pub methods: [MethodValues; 4],
    /// True if they differ by more than noise explains: the signal is not one steady wave in white noise.
    pub disagree: bool,
}

impl Methods {
    /// The values of a comparison over the window that starts at `start`.
    pub fn new(start: u64, comparison: &Comparison) -> Self {
        Self {
            start,
            methods: comparison.methods.map(|method| MethodValues {
                main_amplitude: method.wave.shape.main_amplitude,
                quadrature_amplitude: method.wave.shape.quadrature_amplitude,
                angle: method.wave.shape.angle,
                rank: method.rank,
            }),
            disagree: comparison.disagree,
        }
    }
}

//! A recording as a source for the emulator, read through semihosting, half a ring at a time: a WAV file of two 16-bit channels, S_C left,
//! at any sample rate; or else 12-bit codes of the STM32F405's converters, 16 bits each, S_C and S_D in turn, lowest byte first. Of the
//! latter `firmware/run` takes only files called `*.raw`, as any file would pass for codes.
//!
//! The command line of semihosting is the recording's name and, for tests, options that cause faults:
//!
//! | option | effect |
//! |---|---|
//! | `hold=N` | no pair comes before N commands are answered |
//! | `slow=N` | N halves of the ring come in each round of the main loop |
//! | `shut=A:B` | the reader takes no byte from half A to half B |
//! | `lapse=A:N` | N pairs are lost before half A, as by an overrun |
//! | `panic=A` | a panic at half A |

#![allow(unsafe_code, reason = "semihosting calls take addresses")]

use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use antinode::Packed;
use antinode_telemetry::{Cause, Configuration, FrontEnd};
use cortex_m_semihosting::syscall;

use crate::sampling::{
    AD7380_RAILS, DUAL_ADC_RAILS, Lapse, Ready, Source, both, is_at_rail_12, is_at_rail_16,
};
use crate::settings::{HALF, configuration};
use crate::wav::{Wav, is_wav};

/// Longest command line, bytes.
const MAX_LINE: usize = 256;
/// Semihosting's mode to open a file for reading, in binary.
const READ_BYTES: usize = 1;

static ENDED: AtomicBool = AtomicBool::new(false);
static HALVES: AtomicU32 = AtomicU32::new(0);

/// True once the recording has ended.
pub fn has_ended() -> bool {
    ENDED.load(Ordering::Relaxed)
}

/// Halves of the ring read so far.
pub fn halves() -> u32 {
    HALVES.load(Ordering::Relaxed)
}

/// Options of the command line.
#[derive(Debug, Clone, Copy, Default)]
pub struct Script {
    /// Commands that must be answered before the first pair.
    pub hold: u32,
    /// Halves in each round of the main loop, 1 or more.
    pub slow: u32,
    /// Halves from the first of which to before the second the reader takes nothing.
    pub shut: [u32; 2],
    /// Half before which pairs are lost, and their count.
    pub lapse: [u32; 2],
    /// Half at which the image panics.
    pub panic: Option<u32>,
}

impl Script {
    /// Reads the command line into `line`, of which then the recording's name and a zero are left; `None` if it is not valid.
    pub fn read(line: &mut [u8; MAX_LINE + 1]) -> Option<Self> {
        // SAFETY: the host writes at most as many bytes as it is told.
        if unsafe { syscall!(GET_CMDLINE, line.as_mut_ptr(), MAX_LINE) } != 0 {
            return None;
        }
        let mut script = Self {
            slow: 1,
            ..Self::default()
        };
        let end = line.iter().position(|&byte| byte == 0)?;
        let text = core::str::from_utf8(line.get(..end)?).ok()?;
        let mut words = text.split_ascii_whitespace();
        let name = words.next()?.len();
        for word in words {
            let (key, value) = word.split_once('=')?;
            let (first, second) = value.split_once(':').unwrap_or((value, "0"));
            let numbers = [first.parse().ok()?, second.parse().ok()?];
            match key {
                "hold" => script.hold = numbers[0],
                "slow" => script.slow = numbers[0],
                "shut" => script.shut = numbers,
                "lapse" => script.lapse = numbers,
                "panic" => script.panic = Some(numbers[0]),
                _ => return None,
            }
        }
        *line.get_mut(name)? = 0;
        Some(script)
    }

    /// True if the reader takes bytes.
    pub fn is_open(&self) -> bool {
        !(self.shut[0]..self.shut[1]).contains(&halves())
    }
}

/// A line for [`Script::read`].
pub const fn line() -> [u8; MAX_LINE + 1] {
    [0; MAX_LINE + 1]
}

/// A recording as a source.
pub struct Replay {
    file: usize,
    pairs: [Packed; HALF],
    length: usize,
    /// Pairs that are still to be read.
    left: u32,
    wav: Option<Wav>,
    script: Script,
}

impl Replay {
    /// Opens the recording whose name, with a zero after it, is at the start of `line`; `None` if that is not possible.
    pub fn open(line: &[u8; MAX_LINE + 1], script: Script) -> Option<Self> {
        let name = line.iter().position(|&byte| byte == 0)?;
        // SAFETY: the name and the zero behind it lie in `line`.
        let file = unsafe { syscall!(OPEN, line.as_ptr(), READ_BYTES, name) };
        if file == usize::MAX {
            return None;
        }
        let mut first = [0; 4];
        let wav = if read_at(file, 0, &mut first) && is_wav(&first) {
            Some(Wav::find(|at, buffer| read_at(file, at, buffer))?)
        } else {
            None
        };
        // SAFETY: plain numbers.
        unsafe { syscall!(SEEK, file, wav.map_or(0, |wav| wav.start)) };
        Some(Self {
            file,
            pairs: [Packed(0); HALF],
            length: 0,
            left: wav.map_or(u32::MAX, |wav| wav.pairs),
            wav,
            script,
        })
    }

    /// The device's configuration for this recording.
    pub fn configuration(&self) -> Configuration {
        let mut configuration = configuration(FrontEnd::Synthetic, self.codes());
        if let Some(wav) = self.wav {
            configuration.settings.sample_rate = wav.sample_rate.into();
        }
        configuration
    }

    /// The lowest and the highest code.
    fn codes(&self) -> [i16; 2] {
        if self.wav.is_some() {
            AD7380_RAILS
        } else {
            DUAL_ADC_RAILS
        }
    }

    /// Reads up to `pairs` pairs.
    fn read(&mut self, pairs: usize) {
        let bytes = 4 * pairs.min(HALF).min(self.left as usize);
        // SAFETY: the host writes at most `bytes` bytes, which the pairs have; a pair may have any bits.
        let missing = unsafe { syscall!(READ, self.file, self.pairs.as_mut_ptr(), bytes) };
        self.length = bytes.saturating_sub(missing) / 4;
        self.left -= self.length as u32;
    }
}

/// Fills a buffer from byte `at` of a file; false if the file is too short.
fn read_at(file: usize, at: u32, buffer: &mut [u8]) -> bool {
    // SAFETY: the host writes at most as many bytes as the buffer has.
    unsafe {
        syscall!(SEEK, file, at) == 0
            && syscall!(READ, file, buffer.as_mut_ptr(), buffer.len()) == 0
    }
}

impl Source for Replay {
    type Pair = Packed;

    fn next(&mut self) -> Ready {
        let half = HALVES.load(Ordering::Relaxed);
        HALVES.store(half + 1, Ordering::Relaxed);
        if self.script.panic == Some(half) {
            panic!("as the command line asks");
        }
        if self.script.lapse[1] > 0 && self.script.lapse[0] == half {
            return Ready::Lapse(self.restart(Cause::Overrun));
        }
        self.read(HALF);
        if self.length == 0 {
            ENDED.store(true, Ordering::Relaxed);
            return Ready::Nothing;
        }
        Ready::Pairs
    }

    fn pairs(&self) -> &[Packed] {
        self.pairs.get(..self.length).unwrap_or(&[])
    }

    fn is_intact(&self) -> bool {
        true
    }

    fn restart(&mut self, cause: Cause) -> Lapse {
        let mut lost = 0;
        while lost < self.script.lapse[1] {
            self.read((self.script.lapse[1] - lost) as usize);
            if self.length == 0 {
                break;
            }
            lost += self.length as u32;
        }
        Lapse { cause, lost }
    }

    fn rails(&self) -> [Packed; 2] {
        both(self.codes())
    }

    fn is_at_rail(&self, pair: Packed) -> bool {
        if self.wav.is_some() {
            return is_at_rail_16(pair);
        }
        is_at_rail_12(pair)
    }
}

//! The position of the samples in a WAV file of two channels of 16-bit PCM, S_C left and S_D right.

/// Position and rate of the samples in a WAV file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wav {
    /// Sample pairs a second, Hz.
    pub sample_rate: u32,
    /// Byte at which the samples begin.
    pub start: u32,
    /// Sample pairs, at most: the file may end before.
    pub pairs: u32,
}

/// True if these are the first bytes of a WAV file; 12-bit codes cannot have these bytes.
pub fn is_wav(first: &[u8; 4]) -> bool {
    first == b"RIFF"
}

impl Wav {
    /// Finds the samples; `None` if there are none, or if they are not two channels of 16-bit PCM. `read` fills a buffer from a given byte
    /// of the file on, and gives false if it cannot.
    pub fn find(mut read: impl FnMut(u32, &mut [u8]) -> bool) -> Option<Self> {
        let mut word = |at: u32| {
            let mut bytes = [0; 4];
            read(at, &mut bytes).then_some(bytes)
        };
        if word(8)? != *b"WAVE" {
            return None;
        }
        let (mut at, mut sample_rate) = (12u32, None);
        loop {
            let (id, length) = (word(at)?, u32::from_le_bytes(word(at + 4)?));
            let start = at.checked_add(8)?;
            match &id {
                b"fmt " => {
                    let [coding, _, channels, _] = word(start)?;
                    // 1: PCM. 0xFFFE: the extension tells, which for 16 bits means PCM.
                    if !matches!(coding, 0x01 | 0xFE)
                        || channels != 2
                        || word(start + 12)?[2..] != [16, 0]
                    {
                        return None;
                    }
                    sample_rate = Some(u32::from_le_bytes(word(start + 4)?));
                }
                b"data" => {
                    return Some(Self {
                        sample_rate: sample_rate?,
                        start,
                        // A program that writes to a pipe leaves 0: the samples then extend to the file's end.
                        pairs: if length == 0 { u32::MAX } else { length / 4 },
                    });
                }
                _ => {}
            }
            // Chunks have an even length.
            at = start.checked_add(length.checked_next_multiple_of(2)?)?;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec::Vec;

    fn file(coding: u16, channels: u16, bits: u16) -> Vec<u8> {
        let mut file = b"RIFF\0\0\0\0WAVELIST\x03\0\0\0abc\0fmt \x10\0\0\0".to_vec();
        for word in [coding, channels, 0x86a0, 1, 0, 0, 4, bits] {
            file.extend(word.to_le_bytes());
        }
        file.extend(b"data\x08\0\0\0\x01\0\x02\0\x03\0\x04\0");
        file
    }

    fn find(file: &[u8]) -> Option<Wav> {
        Wav::find(|at, buffer| {
            let at = at as usize;
            file.get(at..at + buffer.len())
                .map(|bytes| buffer.copy_from_slice(bytes))
                .is_some()
        })
    }

    #[test]
    fn samples_are_found_behind_other_chunks() {
        let wav = Wav {
            sample_rate: 100_000,
            start: 56,
            pairs: 2,
        };
        assert_eq!(find(&file(1, 2, 16)), Some(wav));
        assert_eq!(find(&file(0xFFFE, 2, 16)), Some(wav));
    }

    #[test]
    fn samples_without_a_length_go_on_to_the_end() {
        let mut file = file(1, 2, 16);
        file[52..56].fill(0);
        assert_eq!(find(&file).map(|wav| wav.pairs), Some(u32::MAX));
    }

    #[test]
    fn other_samples_are_refused() {
        for refused in [
            file(3, 2, 16),
            file(1, 1, 16),
            file(1, 2, 24),
            file(1, 2, 16)[..40].to_vec(),
            [b"RIFF\0\0\0\0AVI ", &file(1, 2, 16)[12..]].concat(),
        ] {
            assert_eq!(find(&refused), None);
        }
    }
}

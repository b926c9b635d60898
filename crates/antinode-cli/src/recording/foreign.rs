//! Formats that are recognised by their first bytes but not read, each with the way to convert it.

use super::content::has_control;
use super::error::Fault;

/// A format that is recognised but not read.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Foreign {
    /// The bytes that identify it, and their offset.
    mark: &'static [u8],
    at: usize,
    /// The format in words, as after "this is".
    kind: &'static str,
    /// What to do, with `FILE` for its name.
    remedy: &'static str,
}

/// Number of first bytes that identifies most of these formats.
pub(super) const FEW_BYTES: usize = 12;

/// Number of first bytes for formats that the first few leave open.
pub(super) const MORE_BYTES: usize = 64;

const ZIP: &[u8] = b"PK\x03\x04";

/// The beginning of a LeCroy waveform, which announces a length of nine digits; a comment may begin so too.
const LECROY: &[u8] = b"#9";

/// The beginning of candump's times, `(1600000000.123456) can0`.
const CANDUMP_TIME: &[u8] = b"(1";

/// Longest mark, in bytes, that may begin a text by chance.
const MAX_TEXT_LIKE: usize = 4;

const MATLAB: &str = "write text in MATLAB or Octave, `load('FILE'); dlmwrite('both.csv', [c(:) d(:)], 'precision', 9)`, with the names of your two \
                      signals for c and d";
const HDF5: &str = "write NPY in Python, `import h5py, numpy; f = h5py.File(r'FILE'); numpy.save('both.npy', numpy.stack([f['c'][()].ravel(), \
                    f['d'][()].ravel()], axis=1))`, with the names of your two signals for c and d";
const NPZ: &str = "write NPY in Python, `import numpy; z = numpy.load(r'FILE'); numpy.save('both.npy', numpy.stack([z['c'], z['d']], axis=1))`, \
                   with the names of your two signals for c and d";
const TDMS: &str = "write text in Python with npTDMS, `from nptdms import TdmsFile; TdmsFile.read(r'FILE').as_dataframe().to_csv('both.csv', \
                    index=False)`";
const PARQUET: &str = "write text in Python, `import pandas; pandas.read_parquet(r'FILE').to_csv('both.csv', index=False)`";
const FEATHER: &str = "write text in Python, `import pandas; pandas.read_feather(r'FILE').to_csv('both.csv', index=False)`";
const SCOPE: &str = "save the waveforms as CSV, on the oscilloscope or by its maker's program";
const SOX: &str = "convert it, `sox FILE -t wav - | antinode identify -`";
const LOSSY: &str = "its compression is lossy: record WAV or FLAC; only for a quick look, `sox FILE -t wav - | antinode identify -`";
const SHEET: &str = "save its sheet as CSV";
const SPICE: &str = "write WAV, which has even steps, by the directive `.wave both.wav 32 100k V(c) V(d)` of LTspice, with the names of your \
                     two signals for c and d; they are clipped at 1 V";
const CANDUMP: &str = "if each frame begins with S_C and S_D, 16 bits each, least significant byte first (otherwise put `s>2` for s<2), \
                       `perl -ne 'print join(\",\", unpack(\"s<2\", pack(\"H*\", $1))), \"\\n\" if /#([0-9A-F]{8})/' FILE | antinode identify -`";
const GZIP: &str = "unpack it, `gzip -dc FILE | antinode identify -`";
const BZIP2: &str = "unpack it, `bzip2 -dc FILE | antinode identify -`";
const XZ: &str = "unpack it, `xz -dc FILE | antinode identify -`";
const ZSTD: &str = "unpack it, `zstd -dc FILE | antinode identify -`";
const UN7Z: &str = "if it holds only one recording, `7z x -so FILE | antinode identify -`; otherwise unpack it first";
const UNZIP: &str = "if it holds only one recording, `unzip -p FILE | antinode identify -`; otherwise unpack it first";

/// MATLAB files of level 4, which have no mark: they are recognised by their extension alone.
pub(super) static MAT: Foreign = of(b"", "a MATLAB file", MATLAB);
const ARRAYS: Foreign = of(ZIP, "an NPZ archive of NumPy", NPZ);
const WORKBOOK: Foreign = of(ZIP, "a spreadsheet", SHEET);
const ARCHIVE: Foreign = of(ZIP, "a ZIP archive", UNZIP);

static KNOWN: [Foreign; 35] = [
    of(b"MATLAB 5.0 M", "a MATLAB file", MATLAB),
    of(b"MATLAB 7.3 M", "a MATLAB file", MATLAB),
    of(b"Octave-1-", "a binary file of Octave", MATLAB),
    of(b"\x89HDF\r\n\x1a\n", "an HDF5 file", HDF5),
    of(b"TDSm", "a TDMS file of LabVIEW", TDMS),
    of(b"PAR1", "a Parquet file", PARQUET),
    of(b"ARROW1\0\0", "a Feather file", FEATHER),
    of(b"\x1f\x8b\x08", "compressed by gzip", GZIP),
    of(b"BZh91AY&SY", "compressed by bzip2", BZIP2),
    of(b"\xfd7zXZ\0", "compressed by xz", XZ),
    of(b"\x28\xb5\x2f\xfd", "compressed by zstd", ZSTD),
    of(b"7z\xbc\xaf\x27\x1c", "a 7-Zip archive", UN7Z),
    of(
        b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1",
        "an Excel workbook",
        SHEET,
    ),
    of(b"fLaC", "a FLAC file", SOX),
    of(b"AIF", "an AIFF file", SOX).at(8),
    of(b".snd", "an AU file", SOX),
    of(b"caff", "a CAF file", SOX),
    of(b"riff\x2e\x91\xcf\x11", "a Wave64 file", SOX),
    of(b"OggS", "an Ogg file", LOSSY),
    of(b"ID3", "an MP3 file", LOSSY),
    of(b"\xff\xfb", "an MP3 file", LOSSY),
    of(b":WFM#00", "a waveform of Tektronix (.wfm)", SCOPE).at(2),
    of(b":WFMP", "a waveform of Tektronix (.isf)", SCOPE),
    of(b":WFMO", "a waveform of Tektronix (.isf)", SCOPE),
    of(b"WAVEDESC", "a waveform of LeCroy (.trc)", SCOPE),
    of(b"WAVEDESC", "a waveform of LeCroy (.trc)", SCOPE).at(11),
    of(b"Title: * ", "a file of LTspice (.raw)", SPICE),
    of(b") can", "a log of candump", CANDUMP).at(18),
    of(b"AG01", "a waveform of Keysight (.bin)", SCOPE),
    of(b"AG03", "a waveform of Keysight (.bin)", SCOPE),
    of(b"AG10", "a waveform of Keysight (.bin)", SCOPE),
    of(b"RG01", "a waveform of Rigol (.bin)", SCOPE),
    of(b"RG03", "a waveform of Rigol (.bin)", SCOPE),
    of(b"\xa5\xa5\0\0", "a waveform of Rigol (.wfm)", SCOPE),
    of(b"\xa5\xa5\x38\0", "a waveform of Rigol (.wfm)", SCOPE),
];

/// A format whose mark stands at the beginning.
const fn of(mark: &'static [u8], kind: &'static str, remedy: &'static str) -> Foreign {
    Foreign {
        mark,
        at: 0,
        kind,
        remedy,
    }
}

impl Foreign {
    /// The same with the mark at another offset.
    const fn at(self, at: usize) -> Self {
        Self { at, ..self }
    }

    /// The fault of a file of this format.
    pub fn fault(&self) -> Fault {
        let Self { kind, remedy, .. } = self;
        Fault::new(format!("this is {kind}, which is not read; {remedy}"))
    }

    /// How many of the first bytes are needed to identify a file, given the first few.
    pub fn head_bytes(few: &[u8]) -> usize {
        let is_more = [ZIP, LECROY, CANDUMP_TIME]
            .iter()
            .any(|mark| few.starts_with(mark));
        if is_more { MORE_BYTES } else { FEW_BYTES }
    }

    /// The format of a file that begins with `head`, if it is one of these.
    pub fn find(head: &[u8]) -> Option<&'static Self> {
        if head.starts_with(ZIP) {
            return Some(zipped(head));
        }
        let few = &head[..head.len().min(FEW_BYTES)];
        // The last character may be cut in two.
        let is_text = !has_control(few)
            && str::from_utf8(few).map_or_else(|fault| fault.error_len().is_none(), |_| true);
        KNOWN.iter().find(|known| {
            let begins = head
                .get(known.at..)
                .is_some_and(|head| head.starts_with(known.mark));
            begins && !(is_text && known.mark.len() <= MAX_TEXT_LIKE)
        })
    }
}

/// What a ZIP archive holds, by the name of the first file in it.
fn zipped(head: &[u8]) -> &'static Foreign {
    let has = |part: &[u8]| head.windows(part.len()).any(|bytes| bytes == part);
    if has(b".npy") {
        &ARRAYS
    } else if has(b".xml") || has(b"_rels/") || has(b"mimetype") {
        &WORKBOOK
    } else {
        &ARCHIVE
    }
}

#[cfg(test)]
mod tests;

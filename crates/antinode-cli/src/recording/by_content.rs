//! The choice of a reader for a stream: by its content, or else by its extension and the options.

use super::columns::Columns;
use super::content::Content;
use super::error::Fault;
use super::foreign::MAT;
use super::raw;
use super::sample::Kind;
use super::source::{Known, Opened, Stream, in_utf8};
use super::{delimited, npy, wav};

/// What the user tells of a recording beside its content.
#[derive(Debug, Clone, Default)]
pub struct OpenOptions {
    /// The format of raw samples: applies to a stream that is neither WAV nor NPY by its first bytes, nor text by both name and content.
    pub raw: Option<Kind>,
    /// The number of interleaved channels of raw samples, 2 by default.
    pub channels: Option<usize>,
    /// The columns of a text recording, or the channels of another; by default they follow from the header or from how many there are.
    pub columns: Option<Columns>,
    /// The sample rate that takes precedence over the recording's own, Hz.
    pub rate: Option<f64>,
}

/// Neither the content nor the extension is known.
pub(super) const UNKNOWN: &str = "the format is not known, neither by content nor by extension; give a .wav, .csv, .tsv, .txt, .lvm or .npy \
                                  file, or for raw samples their format with --raw u8, i8, u16, i16, i24, i32, f16, f32 or f64, or for text \
                                  the columns with --columns";
/// Standard input of no known format, without a sample format.
pub(super) const RAW_FORMAT_NEEDED: &str = "this is neither WAV, NPY nor CSV; for raw samples give their format with --raw u8, i8, u16, i16, \
                                            i24, i32, f16, f32 or f64 (little-endian, S_C and S_D interleaved), or for text the columns with \
                                            --columns";

/// Opens a stream by its content, or else by what is known about it otherwise.
pub(super) fn open(stream: Stream, known: Known, options: &OpenOptions) -> Result<Opened, Fault> {
    let length = known.length;
    let is_named_text = matches!(known.extension.as_str(), "csv" | "tsv" | "txt" | "lvm");
    let mut is_text = options.raw.is_none() && (is_named_text || options.columns.is_some());
    // Raw samples may have any name: where their format is given, a text's extension counts only if the content is text too.
    let try_text = !is_text && (options.raw.is_none() || is_named_text);
    let (mut content, mut stream) = Content::look(stream, try_text)?;
    // Raw samples may happen to begin as UTF-16 does.
    if content == Content::Utf16 && (is_named_text || options.raw.is_none()) {
        (content, stream) = Content::look(Box::new(in_utf8(stream)?), try_text)?;
        // Once decoded, they can no longer be read as raw samples.
        is_text |= is_named_text;
    }
    match (content, known.extension.as_str(), options.raw) {
        (Content::Nothing, ..) => Err(Fault::new(
            "there is nothing in it; check that the recording was saved or sent",
        )),
        (Content::Wav, ..) => wav::open(stream, length, options),
        (Content::Npy, ..) => npy::open(stream, known, options.columns.as_ref()),
        (Content::Foreign(found), _, None) => Err(found.fault()),
        (_, "wav" | "wave", None) => Err(not_of_kind("a WAV file")),
        (_, "npy", None) => Err(not_of_kind("an NPY file")),
        _ if is_text || content == Content::Text => {
            delimited::open(stream, options, length.is_none())
        }
        (_, _, Some(format)) => raw::open(stream, format, options, length),
        (_, "mat", None) => Err(MAT.fault()),
        _ if known.is_named => Err(Fault::new(UNKNOWN)),
        _ => Err(Fault::new(RAW_FORMAT_NEEDED)),
    }
}

/// The fault if the content is not what the extension promises.
fn not_of_kind(kind: &str) -> Fault {
    Fault::new(format!(
        "this is not {kind}, although its extension says so; export it again, correct the extension, or for raw samples give \
         their format with --raw"
    ))
}

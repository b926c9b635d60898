//! Recognition of a stream's format by its first bytes.

use std::io::{self, Cursor, Read};

use super::Stream;
use super::columns::is_known;
use super::foreign::{FEW_BYTES, Foreign};
use super::number::is_number;
use super::source::unmarked_utf_16;
use super::stamps::is_stamp;
use super::text::{MAX_LINE, fields, is_log_head, is_skipped, separator, without_mark};

/// Bytes read at a time while a text's first line is looked for.
const PIECE: usize = 4096;

/// The first bytes of WAV files.
const WAV: [&[u8]; 4] = [b"RIFF", b"RIFX", b"RF64", b"BW64"];

/// The kind of content that the first bytes show.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Content {
    Nothing,
    Wav,
    Npy,
    Utf16,
    /// A known format that is not read.
    Foreign(&'static Foreign),
    /// Text whose first line is a CSV header or numbers, or with such numbers below settings.
    Text,
    Other,
}

impl Content {
    /// Examines a stream, and gives it back whole. Text is recognised only if asked for by `try_text`, for it takes a line or more.
    pub fn look(mut stream: Stream, try_text: bool) -> io::Result<(Self, Stream)> {
        let mut head = Vec::new();
        for most in [|_: &[u8]| FEW_BYTES, Foreign::head_bytes] {
            let more = most(&head) - head.len();
            stream.by_ref().take(more as u64).read_to_end(&mut head)?;
        }
        let mut content = Self::of(&head);
        if try_text && content == Self::Other && is_text(&mut head, &mut stream)? {
            content = Self::Text;
        }
        Ok((content, Box::new(Cursor::new(head).chain(stream))))
    }

    fn of(head: &[u8]) -> Self {
        match head {
            [] => Self::Nothing,
            // Raw samples may happen to contain one of these two names, but hardly both.
            [_, _, _, _, .., b'W', b'A', b'V', b'E'] if WAV.contains(&&head[..4]) => Self::Wav,
            [0x93, b'N', b'U', b'M', b'P', b'Y', ..] => Self::Npy,
            [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => Self::Utf16,
            _ if unmarked_utf_16(head).is_some() => Self::Utf16,
            _ => Foreign::find(head).map_or(Self::Other, Self::Foreign),
        }
    }
}

/// Whether the first line that is neither blank nor a comment is one of CSV, or a later one holds samples; what is read is appended to
/// `head`. Control bytes matter only up to that line, however much has been read by then.
fn is_text(head: &mut Vec<u8>, stream: &mut Stream) -> io::Result<bool> {
    // The bytes of whole lines examined so far, and whether the first line is among them.
    let (mut seen, mut has_begun) = (0, false);
    loop {
        let end = head.iter().rposition(|byte| b"\r\n".contains(byte));
        let end = end.unwrap_or(0).max(seen);
        if let Some(found) = tells_csv(&head[seen..end], &mut has_begun) {
            return Ok(found);
        }
        seen = end;
        if head.len() > MAX_LINE || has_control(&head[seen..]) {
            return Ok(false);
        }
        let before = head.len();
        // One read gives what is there: a slow pipe need not send more than a line.
        let mut piece = [0; PIECE];
        let read = stream.read(&mut piece)?;
        head.extend_from_slice(&piece[..read]);
        if head.len() == before {
            return Ok(tells_csv(&head[seen..], &mut has_begun) == Some(true));
        }
    }
}

/// Whether these lines show CSV: true if one holds samples, or the text's first is one of CSV; false if a line that is no text comes
/// before; none if more lines are needed.
fn tells_csv(text: &[u8], has_begun: &mut bool) -> Option<bool> {
    let mut lines = without_mark(text).split(|byte| b"\r\n".contains(byte));
    lines.find_map(|line| {
        if has_control(line) {
            Some(false)
        } else if is_skipped(line) || is_log_head(line) {
            None
        } else {
            let is_first = !std::mem::replace(has_begun, true);
            (is_first && is_csv(line) || is_pair(line)).then_some(true)
        }
    })
}

/// Whether there are control bytes, which no text has.
pub(super) fn has_control(bytes: &[u8]) -> bool {
    let is_control = |byte: &u8| byte.is_ascii_control() && !byte.is_ascii_whitespace();
    bytes.iter().any(is_control)
}

/// Whether a line holds two numbers or more, and no words.
fn is_pair(line: &[u8]) -> bool {
    let separator = separator(line);
    let fields = || fields(line, separator).filter(|field| !field.is_empty());
    let is_told = |field| is_number(field, separator) || is_stamp(field);
    fields().nth(1).is_some() && fields().all(is_told)
}

/// Whether a line is a CSV header, or numbers.
fn is_csv(line: &[u8]) -> bool {
    if str::from_utf8(line).is_err() {
        return false;
    }
    let separator = separator(line);
    let found: Vec<&[u8]> = fields(line, separator).collect();
    // Words separated by blanks may be prose: one of them must be a known name of a column.
    let is_header = if separator == b' ' {
        found
            .iter()
            .any(|name| str::from_utf8(name).is_ok_and(is_known))
    } else {
        found.len() > 1
    };
    is_header || found.iter().all(|field| is_number(field, separator))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The content recognised in bytes that come one at a time, or a thousandth at a time of many.
    fn content(bytes: &[u8]) -> Content {
        let most = (bytes.len() / 1000).max(1);
        let stream = super::super::tests::Dribble::new(bytes.to_vec(), most);
        let (content, mut stream) = Content::look(Box::new(stream), true).unwrap();
        let mut all = Vec::new();
        stream.read_to_end(&mut all).unwrap();
        assert_eq!(all, bytes);
        content
    }

    #[test]
    fn bytes_after_the_first_samples_do_not_matter_however_many_have_come() {
        for (text, expected) in [
            (&b"1,2\n3,4\n5\x01,6\n"[..], Content::Text),
            (b"time,c,d\n0,1,2\n\0\0\n", Content::Text),
            (b"Samples\n1 2\x07\n3 4\n", Content::Other),
            (b"# \x07\n1,2\n", Content::Other),
        ] {
            for most in [1, 13, 100] {
                let stream = super::super::tests::Dribble::new(text.to_vec(), most);
                let (content, _) = Content::look(Box::new(stream), true).unwrap();
                let text = text.escape_ascii();
                assert_eq!(content, expected, "{text} in parts of {most}");
            }
        }
    }

    #[test]
    fn text_is_known_by_its_first_line_or_its_samples() {
        for text in [
            "1,2\n",
            "0.1 -2e-3\r\n",
            "1\n",
            "time,x,y\n0,1,2",
            "c d\n1 2\n",
            "time;temperature;heat;c;d\n",
            "\u{feff}# a comment as long as you like, \n\n# one more\nt\tx\ty\r0\t1\t2\r",
            "2024-05-01T00:00:00,1,2\n",
            "13:45:01.5 1 2\n",
            "2026-11-28 13:45:01.5 1 2\n",
            "LabVIEW Measurement\t\nSeparator\tTab\n\n0.1\t0.2\t\n",
            // These begin as a Parquet file, a sound file and a waveform do.
            "PAR1,PAR2,PAR3\n1,2,3\n",
            "ID3;ID4\n1;2\n",
            "\u{feff}time,AIF,BIF\n0,1,2\n",
            "t [µs],AIFµ,BIF\n0,1,2\n",
            "#9\n1,2\n",
            "#9 channels of which two are of use, and the others are not\n1,2\n",
        ] {
            assert_eq!(content(text.as_bytes()), Content::Text, "{text}");
        }
        for other in [
            &b"these are no samples at all"[..],
            b"these are\n12 samples\n0.5 mm apart\n",
            b"Samples\n1 2 3\x07",
            b"1,2\x07\n",
            b"# nothing but a comment",
            b"\xe9t\xe9,c,d\n",
            &[b'1'; 100_000],
        ] {
            assert_eq!(content(other), Content::Other);
        }
    }
}

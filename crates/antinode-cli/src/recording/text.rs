//! Lines of text and the numbers in them.

use std::io::{self, BufRead, Cursor, Read};
use std::iter;

use super::Stream;
use super::columns::is_time;
use super::error::Fault;

/// Longest line read, bytes: a few numbers need less, and a file without ends of line must not fill the memory.
pub(super) const MAX_LINE: usize = 1 << 16;

/// Text whose lines end in `\n`, as most do, a `\r` before it being a blank; those of a text with `\r` alone are converted.
pub(super) fn with_line_ends(mut stream: Stream) -> io::Result<Stream> {
    let (mut head, mut byte) = (Vec::new(), [0]);
    // Before a separator, a `\r` ended a line of a file that was pasted to the left of another.
    let is_end = |head: &[u8]| match head {
        // Behind several, all of them blank lines, the next byte tells.
        [.., b'\r', next] => !is_mark(*next) && *next != b'\r',
        _ => head.ends_with(b"\n"),
    };
    while head.len() < MAX_LINE && !is_end(&head) && stream.read(&mut byte)? > 0 {
        head.push(byte[0]);
    }
    let is_converted =
        matches!(head[..], [.., b'\r', next] if !is_mark(next) && !b"\r\n".contains(&next));
    let stream = Cursor::new(head).chain(stream);
    Ok(if is_converted {
        Box::new(Returns(stream))
    } else {
        Box::new(stream)
    })
}

/// Text with `\n` in place of each `\r`.
struct Returns<R>(R);

impl<R: Read> Read for Returns<R> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let count = self.0.read(bytes)?;
        let returns = bytes[..count].iter_mut().filter(|byte| **byte == b'\r');
        returns.for_each(|byte| *byte = b'\n');
        Ok(count)
    }
}

/// The first line that is neither blank nor a comment, perhaps with the next, and its number; the lines above it are added to `above`, up to
/// the length of a line. If the last of them holds names that begin with `#` for a count of lines, these come first, with `n` in place of
/// `#`.
pub(super) fn first_line(
    stream: &mut impl BufRead,
    above: &mut Vec<u8>,
) -> Result<(Vec<u8>, u64), Fault> {
    let (mut line, mut number) = (Vec::new(), 0);
    let mut counted = None;
    loop {
        number += 1;
        line.clear();
        let read = stream
            .by_ref()
            .take(MAX_LINE as u64)
            .read_until(b'\n', &mut line);
        match read? {
            0 => return Err(Fault::no_pairs()),
            MAX_LINE => return Err(Fault::line_too_long(number)),
            _ => {}
        }
        if number == 1 {
            line = without_mark(&line).to_vec();
        }
        if is_skipped(&line) || is_log_head(&line) {
            counted = has_count(&line).then(|| (line.clone(), number));
            let room = MAX_LINE.saturating_sub(above.len());
            above.extend_from_slice(&line[..line.len().min(room)]);
            continue;
        }
        let names = counted.filter(|(names, _)| are_as_many(names, &line));
        let Some((mut names, of_names)) = names else {
            return Ok((line, number));
        };
        let has_time = has_time(&names);
        if !has_time {
            line.extend_from_slice(&next_lines(stream, 1)?);
        }
        if !has_time && !are_counted(&line) {
            return Ok((line, number));
        }
        names[0] = b'n';
        names.extend_from_slice(&line);
        return Ok((names, of_names));
    }
}

/// Whether a comment may be a line of names, the first of which, `#`, stands for a count of lines.
fn has_count(line: &[u8]) -> bool {
    matches!(line, [b'#', b',' | b';' | b'\t', ..])
}

/// Whether one of these names that follow a count of lines is that of a time.
fn has_time(names: &[u8]) -> bool {
    fields(names, names[1])
        .filter_map(|name| str::from_utf8(name).ok())
        .any(is_time)
}

/// Whether the first column of the first two of these lines counts them.
fn are_counted(lines: &[u8]) -> bool {
    let counts = lines.split(|&byte| byte == b'\n').map(|line| {
        let first = fields(line, separator(line)).next()?;
        str::from_utf8(first).ok()?.parse::<u64>().ok()
    });
    let counts: Vec<_> = counts.take(2).collect();
    matches!(counts[..], [Some(one), Some(other)] if one.checked_add(1) == Some(other))
}

/// Whether two lines have the same number of fields, more than two.
fn are_as_many(one: &[u8], other: &[u8]) -> bool {
    let separator = separator(other);
    let count = |line| fields(line, separator).count();
    count(one) == count(other) && count(one) > 2
}

/// The next `lines` lines, comments included; fewer at the end or at one that is too long, of which only the beginning is read.
pub(super) fn next_lines(stream: &mut impl BufRead, lines: usize) -> io::Result<Vec<u8>> {
    let mut next = Vec::new();
    for _ in 0..lines {
        let mut line = stream.by_ref().take(MAX_LINE as u64);
        let read = line.read_until(b'\n', &mut next)?;
        if read == 0 || read == MAX_LINE {
            break;
        }
    }
    Ok(next)
}

/// Text without the byte order mark that some programs begin UTF-8 with.
pub(super) fn without_mark(text: &[u8]) -> &[u8] {
    text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text)
}

/// Whether a line is blank or a comment.
pub(super) fn is_skipped(line: &[u8]) -> bool {
    line.trim_ascii_start().is_empty() || is_comment(line)
}

/// Whether a line is the head that PuTTY writes above a log.
pub(super) fn is_log_head(line: &[u8]) -> bool {
    let line = line.trim_ascii();
    line.starts_with(b"=~=~=~") && line.ends_with(b"=~=")
}

/// Whether a line is a comment.
pub(super) fn is_comment(line: &[u8]) -> bool {
    let line = line.trim_ascii_start();
    let is_marked = [&b"#"[..], b"%", b"//"]
        .into_iter()
        .any(|mark| line.starts_with(mark));
    // sigrok's `; Channels: …`, where `;` separates no fields.
    let is_sentence = matches!(line, [b';', b' ', b'A'..=b'Z', rest @ ..] if !rest.contains(&b';'));
    is_marked || is_sentence
}

/// The separators of fields other than blanks, in the order in which they are looked for.
const MARKS: [u8; 3] = *b";\t,";

fn is_mark(byte: u8) -> bool {
    MARKS.contains(&byte)
}

/// The separator of a line's fields: the first of `;`, tab and `,` that is there, or else blanks.
pub(super) fn separator(line: &[u8]) -> u8 {
    MARKS
        .into_iter()
        .find(|mark| line.contains(mark))
        .unwrap_or(b' ')
}

/// The fields of a line; where blanks separate them, only those that are not empty.
pub(super) fn fields(line: &[u8], separator: u8) -> impl Iterator<Item = &[u8]> {
    let line = line.trim_ascii_end();
    // A single separator at the end of a line does not begin another field.
    let line = line.strip_suffix(&[separator]).unwrap_or(line);
    all_fields(line, separator)
}

/// The same with an empty field behind a separator at the end.
pub(super) fn all_fields(line: &[u8], separator: u8) -> impl Iterator<Item = &[u8]> {
    let fields = raw_fields(line, separator).map(bare);
    fields.filter(move |field| separator != b' ' || !field.is_empty())
}

/// All that stands between separators, with the blanks and quotes around it.
pub(super) fn raw_fields(line: &[u8], separator: u8) -> impl Iterator<Item = &[u8]> {
    let mut rest = Some(line);
    iter::from_fn(move || {
        let line = rest?;
        let end = field_end(line, separator);
        rest = line.get(end + 1..);
        Some(&line[..end])
    })
}

/// Where the first field of a line ends. Separators within quotes belong to it, if the quotes enclose a whole field.
fn field_end(line: &[u8], separator: u8) -> usize {
    let end_from = |from: usize| {
        let end = line[from..].iter().position(|&byte| byte == separator);
        end.map_or(line.len(), |end| from + end)
    };
    let first = end_from(0);
    let opened = line[..first].trim_ascii_start();
    if opened.first() != Some(&b'"') || separator == b' ' {
        return first;
    }
    let mut end = first;
    loop {
        // A quote within quotes is doubled.
        let quotes = line[..end].iter().filter(|&&byte| byte == b'"').count();
        if quotes % 2 == 0 && line[..end].trim_ascii_end().ends_with(b"\"") {
            return end;
        }
        if end == line.len() {
            return first;
        }
        end = end_from(end + 1);
    }
}

/// A field without the blanks and quotes around it.
pub(super) fn bare(field: &[u8]) -> &[u8] {
    let field = field.trim_ascii();
    match field {
        [b'"', inner @ .., b'"'] => inner.trim_ascii(),
        _ => field,
    }
}

#[cfg(test)]
mod tests;

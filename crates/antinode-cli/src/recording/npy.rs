//! NPY files, as `numpy.save` writes them: (N, 2) or (2, N) numbers, or N records of numbers.

use std::cell::Cell;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::rc::Rc;

use npyz::{DType, Endianness, Field, NpyHeader, Order, TypeChar};

use super::columns::{Columns, are_swapped};
use super::error::Fault;
use super::frame::Frame;
use super::raw::{Followed, Interleaved};
use super::sample::{Kind, SampleCode};
use super::source::Known;
use super::{Opened, Source, Stream};

/// Longest header read, bytes: that of a plain array is shorter, and `numpy` itself refuses longer ones.
const MAX_HEADER: usize = 10_000;

/// Deepest nesting of brackets read: a plain array has less, and a far deeper one would exhaust the stack of the parser.
const MAX_DEPTH: usize = 8;

/// Pairs read at a time from an array that stores one channel after the other.
const PLANE_PAIRS: usize = 1 << 14;

/// Opens an NPY file; `columns` are the channels asked for.
pub(super) fn open(
    mut stream: Stream,
    Known {
        again,
        length,
        read: count,
        ..
    }: Known,
    columns: Option<&Columns>,
) -> Result<Opened, Fault> {
    let text = header_text(&mut stream)?;
    let not_understood = || damaged("it cannot be understood");
    let header = NpyHeader::from_reader(text.as_slice()).map_err(|_| not_understood())?;
    let dtype = header.dtype();
    let (code, fields) = match &dtype {
        DType::Record(fields) => (code_of_all(&dtype, fields)?, &fields[..]),
        plain => (code(plain)?, &[][..]),
    };
    let (pairs, channels, is_interleaved) = layout(&header, fields.len(), columns.is_some())?;
    let mut frame = Frame::choose(usize::try_from(channels).unwrap_or(usize::MAX), columns)?;
    if let (None, [one, other]) = (columns, fields)
        && are_swapped([&one.name, &other.name])
    {
        frame.chosen.reverse();
    }
    if pairs == 0 {
        return Err(Fault::no_pairs());
    }
    let start = text.len() as u64;
    let size = code.sample_bytes() as u64;
    let bytes = pairs
        .checked_mul(channels * size)
        .ok_or_else(not_understood)?;
    let available = length.map_or(bytes, |length| bytes.min(length.saturating_sub(start)));
    let (source, there) = if is_interleaved {
        let source = Interleaved::new(stream, code, frame, length.is_none());
        (
            Source::Interleaved(source.promise(bytes, Followed::ByNothing)),
            available / (channels * size),
        )
    } else {
        let again = again.ok_or_else(|| {
            Fault::new(
                "the array holds all of S_C before S_D, which cannot be read from a pipe; name the file instead, or save \
                 `numpy.stack([c, d], axis=1)` in C order",
            )
        })?;
        let [c, d] = frame.chosen.map(|place| place as u64 * pairs * size);
        let there = (available.saturating_sub(c.max(d)) / size).min(pairs);
        let planes = Planes {
            stream: again,
            code,
            starts: [start + c, start + d],
            promised: pairs,
            there,
            is_followed: length.is_some_and(|length| length > start + bytes),
            read: 0,
            count,
            chunks: [Vec::new(), Vec::new(), Vec::new()],
        };
        (Source::Planes(planes), there)
    };
    Ok(Opened::of_samples("NPY of", code, source, Some(there)))
}

/// The numbers of pairs and channels, and whether the samples of a pair follow each other, of an array of records of so many `fields` or, if
/// there are none, of plain numbers; two channels unless others `are_chosen`.
fn layout(header: &NpyHeader, fields: usize, are_chosen: bool) -> Result<(u64, u64, bool), Fault> {
    Ok(match (header.shape(), header.order()) {
        (&[pairs], _) if fields == 2 || fields > 2 && are_chosen => (pairs, fields as u64, true),
        (shape, _) if fields > 0 => {
            return Err(Fault::new(format!(
                "NPY header: the shape is {} of records of {fields} fields, but (N,) of two fields is needed; of more fields choose two, as \
                 in --columns 2,3 if the first is the time, or save `numpy.stack([x['c'], x['d']], axis=1)`",
                shown(shape)
            )));
        }
        (&[pairs, 2], order) => (pairs, 2, order == Order::C),
        (&[2, pairs], order) => (pairs, 2, order == Order::Fortran),
        // The longer side counts the samples: no recording has more channels.
        (&[one, other], order) if are_chosen && one.min(other) > 1 => (
            one.max(other),
            one.min(other),
            (one > other) == (order == Order::C),
        ),
        (shape, _) => {
            return Err(Fault::new(format!(
                "NPY header: the shape is {}, but (N, 2) is needed; of more channels \
                 choose two, as in --columns 2,3 if the first is the time, or save `numpy.stack([c, d], axis=1)`",
                shown(shape)
            )));
        }
    })
}

/// The fault of a damaged header.
fn damaged(fault: &str) -> Fault {
    Fault::new(format!(
        "NPY header: {fault}; save it again with `numpy.save`"
    ))
}

/// Reads the header, and refuses one that would harm its parser.
fn header_text(stream: &mut Stream) -> Result<Vec<u8>, Fault> {
    let mut text = Vec::new();
    let mut read = |text: &mut Vec<u8>, count: usize| {
        if stream.take(count as u64).read_to_end(text)? < count {
            Err(damaged("the file ends inside it"))
        } else {
            Ok(())
        }
    };
    read(&mut text, 10)?;
    let size = match text[6] {
        1 => usize::from(u16::from_le_bytes([text[8], text[9]])),
        _ => {
            read(&mut text, 2)?;
            u32::from_le_bytes([text[8], text[9], text[10], text[11]]) as usize
        }
    };
    if size > MAX_HEADER {
        return Err(damaged("it is too long for an array of numbers"));
    }
    let start = text.len();
    read(&mut text, size)?;
    let (mut depth, mut deepest) = (0usize, 0);
    for byte in &text[start..] {
        match byte {
            b'(' | b'[' | b'{' => depth += 1,
            b')' | b']' | b'}' => depth = depth.saturating_sub(1),
            _ => {}
        }
        deepest = deepest.max(depth);
    }
    // The parser multiplies the sizes in the shape without looking for an overflow.
    let numbers = text[start..].split(|byte| !byte.is_ascii_digit());
    let product = numbers
        .filter(|digits| !digits.is_empty())
        .try_fold(1u64, |product, digits| {
            let number: u64 = str::from_utf8(digits).ok()?.parse().ok()?;
            product.checked_mul(number.max(1))
        });
    if deepest > MAX_DEPTH || product.is_none() {
        return Err(damaged("it cannot be that of an array of numbers"));
    }
    Ok(text)
}

/// The fault of a type that is not read.
fn refused(dtype: &DType) -> Fault {
    Fault::new(format!(
        "NPY header: the dtype is {}, but u1, i1, u2, i2, i4, f2, f4 or f8, or records of one of them, is needed; save \
         `numpy.stack([c, d], axis=1).astype('f4')`",
        dtype.descr()
    ))
}

/// How all `fields` of a record of this type are stored, which must be alike.
fn code_of_all(dtype: &DType, fields: &[Field]) -> Result<SampleCode, Fault> {
    let codes: Option<Vec<SampleCode>> =
        fields.iter().map(|field| code(&field.dtype).ok()).collect();
    match codes.as_deref() {
        Some([first, rest @ ..]) if rest.iter().all(|code| code == first) => Ok(*first),
        _ => Err(refused(dtype)),
    }
}

/// How samples of this number type are stored.
fn code(dtype: &DType) -> Result<SampleCode, Fault> {
    let DType::Plain(plain) = dtype else {
        return Err(refused(dtype));
    };
    let kind = match (plain.type_char(), plain.size_field()) {
        // Unsigned integers of 32 bits are refused: codes of up to 24 bits in them would lie too close to −1 for single precision.
        (TypeChar::Uint, 1) => Kind::U8,
        (TypeChar::Uint, 2) => Kind::U16,
        (TypeChar::Int, 1) => Kind::I8,
        (TypeChar::Int, 2) => Kind::I16,
        (TypeChar::Int, 4) => Kind::I32,
        (TypeChar::Float, 2) => Kind::F16,
        (TypeChar::Float, 4) => Kind::F32,
        (TypeChar::Float, 8) => Kind::F64,
        _ => return Err(refused(dtype)),
    };
    Ok(SampleCode::new(kind).big_endian(plain.endianness() == Endianness::Big))
}

/// A shape as `numpy` shows it.
fn shown(shape: &[u64]) -> String {
    let sizes = format!("{shape:?}");
    let comma = if shape.len() == 1 { "," } else { "" };
    format!("({}{comma})", sizes.trim_matches(['[', ']']))
}

/// A source of pairs from an array that stores one channel after the other.
pub(super) struct Planes {
    stream: File,
    code: SampleCode,
    /// Where S_C and S_D begin in the file, bytes.
    starts: [u64; 2],
    promised: u64,
    /// The number of pairs of which both samples are there.
    there: u64,
    /// Whether something follows the array.
    is_followed: bool,
    read: u64,
    /// The bytes read.
    count: Rc<Cell<u64>>,
    /// S_C, S_D, and both interleaved.
    chunks: [Vec<u8>; 3],
}

impl Planes {
    fn read(&mut self, pairs: usize) -> io::Result<()> {
        let size = self.code.sample_bytes();
        for (start, chunk) in self.starts.iter().zip(&mut self.chunks) {
            chunk.resize(pairs * size, 0);
            self.stream
                .seek(SeekFrom::Start(start + self.read * size as u64))?;
            self.stream.read_exact(chunk)?;
            self.count.set(self.count.get() + chunk.len() as u64);
        }
        let [c, d, both] = &mut self.chunks;
        both.clear();
        for (c, d) in c.chunks_exact(size).zip(d.chunks_exact(size)) {
            both.extend_from_slice(c);
            both.extend_from_slice(d);
        }
        Ok(())
    }

    /// Appends pairs until there are `capacity`, as [`Source::fill`] says.
    pub fn fill(&mut self, pairs: &mut Vec<[f32; 2]>, capacity: usize) -> Result<(), Fault> {
        while pairs.len() < capacity {
            let left = usize::try_from(self.there - self.read).unwrap_or(usize::MAX);
            let count = left.min(capacity - pairs.len()).min(PLANE_PAIRS);
            if count == 0 {
                let (promised, found) = (self.promised, self.there);
                return if found < promised {
                    Err(Fault::truncated(promised, found))
                } else if self.is_followed {
                    Err(Fault::followed(promised))
                } else {
                    Ok(())
                };
            }
            self.read(count)?;
            self.code.decode(&self.chunks[2], pairs, self.read)?;
            self.read += count as u64;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;

//! Decoding of a frame in 1-wire mode, which holds A's bits, then B's, highest bit first.

/// The pair `[A, B]` in the four bytes of a frame, in the order in which they were received.
///
/// ```
/// assert_eq!(ad7380::pair_from_frame([0x7F, 0xFF, 0x80, 0x00]), [i16::MAX, i16::MIN]);
/// ```
#[inline]
pub const fn pair_from_frame(frame: [u8; 4]) -> [i16; 2] {
    pair_from_word(u32::from_be_bytes(frame))
}

/// The pair `[A, B]` in a frame received as one word of 32 bits, highest bit first.
///
/// A is in the high half; `word.rotate_left(16)` has it in the low one.
///
/// ```
/// assert_eq!(ad7380::pair_from_word(0x0001_FFFF), [1, -1]);
/// ```
#[inline]
pub const fn pair_from_word(word: u32) -> [i16; 2] {
    [(word >> 16) as i16, word as i16]
}

/// The pair `[A, B]` of 18 bits each, −131 072 to 131 071, in the five bytes of a frame with resolution boost.
///
/// The results take 36 clocks; the last four bits are ignored.
///
/// ```
/// assert_eq!(ad7380::pair_from_boosted_frame([0x7F, 0xFF, 0xE0, 0x00, 0x00]), [131_071, -131_072]);
/// ```
#[inline]
pub const fn pair_from_boosted_frame(frame: [u8; 5]) -> [i32; 2] {
    let [b0, b1, b2, b3, b4] = frame;
    let a = i32::from_be_bytes([b0, b1, b2, 0]);
    let b = i32::from_be_bytes([b2, b3, b4, 0]);
    // The upper 18 bits of a word are A; B begins two bits into the third byte. The shifts right extend the sign.
    [a >> 14, (b << 2) >> 14]
}

/// True for those of `[A, B]` that are at the lowest or the highest code, and so are probably clipped.
///
/// Clipping before the converter, in an amplifier, is not detected, nor clipping hidden by averaging: [`crate::Alert`] checks the
/// conversions before they are averaged.
///
/// ```
/// assert_eq!(ad7380::at_rail([i16::MIN, 32_766]), [true, false]);
/// ```
#[inline]
pub const fn at_rail(pair: [i16; 2]) -> [bool; 2] {
    let [a, b] = pair;
    [
        a == i16::MIN || a == i16::MAX,
        b == i16::MIN || b == i16::MAX,
    ]
}

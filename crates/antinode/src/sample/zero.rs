//! Zero as a constant: a static of zeros takes neither flash nor stack.

/// Types of samples, sums and tables that have a constant zero.
pub trait Zero: Copy {
    /// Zero, in every element.
    const ZERO: Self;
}

macro_rules! zero {
    ($($number:ty: $zero:expr),*) => {
        $(
            impl Zero for $number {
                const ZERO: Self = $zero;
            }
        )*
    };
}

zero!(i16: 0, i32: 0, i64: 0, u32: 0, u64: 0, f32: 0.0);

impl<T: Zero, const N: usize> Zero for [T; N] {
    const ZERO: Self = [T::ZERO; N];
}

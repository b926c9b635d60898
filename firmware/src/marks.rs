//! The marks that measurements run between, and the way out of the emulator.

// Marks must have the names that a counting tool looks for.
#![allow(unsafe_code, reason = "`no_mangle` is an unsafe attribute")]

use cortex_m_semihosting::debug;

/// The measurement begins with the return from here.
#[unsafe(no_mangle)]
#[inline(never)]
pub extern "C" fn mark_begin() {
    core::hint::black_box(1);
}

/// The measurement ends with the call of this.
#[unsafe(no_mangle)]
#[inline(never)]
pub extern "C" fn mark_end() {
    core::hint::black_box(2);
}

/// Leaves the emulator with success.
pub fn leave() -> ! {
    loop {
        debug::exit(debug::EXIT_SUCCESS);
    }
}

/// Leaves the emulator with failure.
pub fn fail() -> ! {
    loop {
        debug::exit(debug::EXIT_FAILURE);
    }
}

/// An image of one bench, which is called with the image's name and these arguments; it leaves the emulator where it panics too.
#[macro_export]
macro_rules! bench_image {
    ($bench:expr $(, $argument:expr)*) => {
        #[cortex_m_rt::entry]
        fn main() -> ! {
            $bench(env!("CARGO_BIN_NAME") $(, $argument)*)
        }

        #[panic_handler]
        fn panic(_: &core::panic::PanicInfo) -> ! {
            $crate::marks::leave()
        }
    };
}

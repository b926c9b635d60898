//! The marks of a measurement's begin and end, and the exits from the emulator.

// Counting tools find the marks by name.
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

/// The entry point of a bench image, which calls the bench with the image's name and these arguments. A panic leaves the emulator too.
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

//! Handlers of panics, hard faults and a stopped crystal: each restarts the device, with a note of the cause.

use core::panic::PanicInfo;

use antinode_telemetry::Cause;
use cortex_m_rt::{ExceptionFrame, exception};
use firmware::hardware::reset;

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    reset::panicked(info)
}

#[allow(unsafe_code, reason = "cortex-m-rt declares this handler unsafe")]
#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    reset::faulted(frame)
}

/// The clock security system: the crystal has stopped.
#[allow(unsafe_code, reason = "cortex-m-rt declares this handler unsafe")]
#[exception]
unsafe fn NonMaskableInt() -> ! {
    reset::restart(Cause::Clock, 0)
}

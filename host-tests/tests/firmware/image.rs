//! Properties of the images: no panics, sizes, memory functions.

use std::process::{Command, Stdio};

use crate::emulator::images;

/// Largest flash of each image, bytes, and largest RAM with all buffers.
const FLASH: [(&str, u64); 2] = [("stm32f405", 51_300), ("stm32f405_ad7380", 53 * 1024)];
const RAM: u64 = 20 * 1024;

/// Output of a tool for an image.
pub fn output(tool: &str, args: &[&str], image: &str) -> String {
    let output = Command::new(tool)
        .args(args)
        .arg(images().join(image))
        .output()
        .expect("binutils are installed");
    assert!(output.status.success(), "{tool} on {image}");
    String::from_utf8(output.stdout).expect("plain text")
}

#[test]
#[ignore = "needs the ARM target"]
fn no_image_can_panic() {
    for image in ["stm32f405", "stm32f405_ad7380"] {
        let symbols = output("nm", &["-C"], image);
        assert!(symbols.contains("_SEGGER_RTT"), "no symbols to look at");
        let panics: Vec<_> = symbols
            .lines()
            .filter(|line| line.contains("panicking") || line.contains("unwrap_failed"))
            .collect();
        assert!(panics.is_empty(), "{image} links panics in: {panics:#?}");
    }
}

#[test]
#[ignore = "needs the ARM target"]
fn images_fit_into_flash_and_ram() {
    for (image, most) in FLASH {
        let sections = output("size", &["-A", "-d"], image);
        let size = |names: &[&str]| -> u64 {
            let of = |line: &str| {
                let mut words = line.split_ascii_whitespace();
                let wanted = words.next().is_some_and(|name| names.contains(&name));
                words.next().filter(|_| wanted)?.parse::<u64>().ok()
            };
            sections.lines().filter_map(of).sum::<u64>()
        };
        let flash = size(&[".vector_table", ".text", ".rodata", ".data", ".gnu.sgstubs"]);
        let ram = size(&[".data", ".bss", ".uninit"]);
        println!("{image}: {flash} bytes of flash, {ram} bytes of RAM without the stack");
        assert!(
            flash > 10_000 && flash <= most,
            "{image}: {flash} bytes of flash"
        );
        assert!(ram > 4_000 && ram <= RAM, "{image}: {ram} bytes of RAM");
    }
}

#[test]
#[ignore = "needs the ARM target"]
fn memory_functions_copy_and_clear_rightly() {
    let output = Command::new("timeout")
        .args(["60", "qemu-system-arm", "-machine", "netduinoplus2"])
        .args(["-display", "none", "-monitor", "none", "-serial", "none"])
        .args(["-semihosting-config", "enable=on,target=native", "-kernel"])
        .arg(images().join("check_memory"))
        .stdin(Stdio::null())
        .output()
        .expect("qemu-system-arm must be installed");
    let lines = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{lines}");
    assert_eq!(lines.matches(": right").count(), 9, "{lines}");
}

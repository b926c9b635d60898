//! Properties of the images: no panics, sizes, memory functions.

use std::process::{Command, Stdio};

use crate::emulator::images;

/// Largest flash of each image, bytes, and largest RAM with all buffers.
const FLASH: [(&str, u64); 2] = [("stm32f405", 51_900), ("stm32f405_ad7380", 54 * 1024)];
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
fn wfi_has_a_line_of_flash_of_its_own() {
    for image in ["stm32f405", "stm32f405_ad7380"] {
        let listing = output("arm-none-eabi-objdump", &["-d"], image);
        let lines: Vec<&str> = listing.lines().collect();
        let is = |line: &str, mnemonic: &str| line.split('\t').any(|word| word.trim() == mnemonic);
        let places: Vec<_> = (0..lines.len()).filter(|&i| is(lines[i], "wfi")).collect();
        assert!(!places.is_empty(), "{image}");
        for place in places {
            assert!(lines[place].contains("0:\t"), "{image}: {}", lines[place]);
            let after = lines.get(place + 1..place + 8).unwrap_or_default();
            assert!(after.iter().all(|line| is(line, "nop")), "{after:#?}");
        }
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

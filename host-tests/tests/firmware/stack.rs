//! The deepest stack of an image: the stack of each function, summed along the deepest chain of calls.
//!
//! It is complete as long as no call goes through a register, which is asserted.

use std::collections::HashMap;
use std::process::Command;

use crate::emulator::images;

/// A function of an image.
#[derive(Default)]
struct Function {
    name: String,
    /// Bytes of stack.
    frame: u32,
    /// Targets of its branches, also within itself.
    targets: Vec<u32>,
}

/// Bytes that an instruction takes from the stack.
fn taken(mnemonic: &str, operands: &str) -> u32 {
    let number = |text: &str| text.trim_matches(['#', ']', '!']).parse::<u32>().ok();
    let last = || operands.rsplit([' ', ',']).find_map(number).unwrap_or(0);
    let registers = |size: u32| {
        let list = operands.split(['{', '}']).nth(1).unwrap_or("");
        let of = |register: &str| register.trim()[1..].parse::<u32>().unwrap_or(0);
        let count = |entry: &str| entry.split_once('-').map_or(1, |(a, b)| of(b) + 1 - of(a));
        size * list.split(',').map(count).sum::<u32>()
    };
    match mnemonic {
        "push" | "push.w" => registers(4),
        "stmdb" if operands.starts_with("sp!") => registers(4),
        "vpush" => registers(if operands.contains("{d") { 8 } else { 4 }),
        "sub" | "sub.w" | "subw" if operands.starts_with("sp,") => last(),
        "str.w" | "strd" | "vstr" | "str" => match operands.split_once("[sp, #-") {
            Some((_, rest)) if rest.ends_with("]!") => number(rest).unwrap_or(0),
            _ => 0,
        },
        _ => 0,
    }
}

/// The functions of an image by their addresses.
fn functions(image: &str) -> HashMap<u32, Function> {
    let output = Command::new("arm-none-eabi-objdump")
        .args(["-d", "-C", "--no-show-raw-insn"])
        .arg(images().join(image))
        .output()
        .expect("the package binutils-arm-none-eabi must be installed");
    assert!(output.status.success(), "{image}");
    let listing = String::from_utf8(output.stdout).expect("plain text");
    let hexadecimal = |text: &str| u32::from_str_radix(text, 16).ok();
    let mut functions = HashMap::new();
    let mut here = 0;
    for line in listing.lines() {
        if let Some((address, name)) = line.strip_suffix(">:").and_then(|l| l.split_once(" <")) {
            here = hexadecimal(address).expect("an address");
            let function = Function {
                name: name.to_owned(),
                ..Function::default()
            };
            functions.insert(here, function);
            continue;
        }
        let mut columns = line.trim().splitn(3, '\t');
        let (Some(_), Some(mnemonic), Some(operands)) =
            (columns.next(), columns.next(), columns.next())
        else {
            continue;
        };
        let Some(function) = functions.get_mut(&here) else {
            continue;
        };
        // A comment begins with a semicolon or an at sign.
        let operands = operands.split([';', '@']).next().unwrap_or("").trim();
        let by_register = matches!(mnemonic, "blx" | "bx") && operands != "lr";
        assert!(
            !by_register,
            "{image}: {} calls through a register: {line}",
            function.name
        );
        function.frame += taken(mnemonic, operands);
        if mnemonic.starts_with('b') || mnemonic.starts_with("cb") {
            let target = operands.split(" <").next().unwrap_or("");
            let target = target.rsplit(' ').next().and_then(hexadecimal);
            function.targets.extend(target);
        }
    }
    functions
}

/// The deepest chain from a function on, as bytes and names; `known` has those that are finished, and `None` for those in progress.
fn deepest(
    functions: &HashMap<u32, Function>,
    address: u32,
    known: &mut HashMap<u32, Option<(u32, String)>>,
) -> (u32, String) {
    let Some(function) = functions.get(&address) else {
        // A branch within a function.
        return (0, String::new());
    };
    if let Some(known) = known.get(&address) {
        return known
            .clone()
            .unwrap_or_else(|| panic!("{} recurs", function.name));
    }
    known.insert(address, None);
    let targets = function.targets.iter().filter(|&&target| target != address);
    let calls = targets
        .map(|&target| deepest(functions, target, known))
        .max();
    let (bytes, chain) = calls.unwrap_or_default();
    let chain = format!("\n  {} {}{chain}", function.frame, function.name);
    let found = (function.frame + bytes, chain);
    known.insert(address, Some(found.clone()));
    found
}

#[test]
#[ignore = "needs the ARM target and binutils for it"]
fn stacks_are_within_the_stated_limits() {
    let functions = functions("stm32f405");
    let mut known = HashMap::new();
    // At the start, in the main loop, and in the converters' interrupt, which is also that of their DMA.
    for (root, most) in [("main", 1400), ("stm32f405::app::idle", 1400), ("ADC", 650)] {
        let (&address, _) = functions
            .iter()
            .find(|(_, function)| function.name == root)
            .unwrap_or_else(|| panic!("no {root} in the image"));
        let (bytes, chain) = deepest(&functions, address, &mut known);
        println!("{root}: {bytes} bytes{chain}");
        assert!(
            bytes > 100 && bytes <= most,
            "{root} takes {bytes} bytes of stack"
        );
    }
}

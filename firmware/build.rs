//! Hands the linker the memory map at the top of the project.

use std::ffi::OsStr;
use std::path::PathBuf;
use std::{env, fs};

fn main() {
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    fs::write(out.join("memory.x"), include_str!("../memory.x")).expect("OUT_DIR can be written");
    // `check_arch` compiles the core's kernels; an image for a Cortex-M4F has the instructions of all of them.
    println!("cargo:rustc-check-cfg=cfg(has_dsp, has_vsqrt)");
    if env::var("TARGET").is_ok_and(|target| target == "thumbv7em-none-eabihf") {
        println!("cargo:rustc-cfg=has_dsp");
        println!("cargo:rustc-cfg=has_vsqrt");
    }
    println!("cargo:rustc-link-search={}", out.display());
    println!("cargo:rerun-if-changed=../memory.x");
    // On the host there is nothing to link but tests.
    if env::var("CARGO_CFG_TARGET_OS").as_deref() != Ok("none") {
        return;
    }
    for kind in ["bins", "examples"] {
        println!("cargo:rustc-link-arg-{kind}=-Tlink.x");
        println!("cargo:rustc-link-arg-{kind}=--nmagic");
    }
    // All others log nothing.
    println!("cargo:rerun-if-changed=src/bin");
    for image in fs::read_dir("src/bin").expect("there are images") {
        let image = image.expect("the folder can be read").path();
        let name = image.file_stem().and_then(OsStr::to_str).expect("a name");
        if name == "replay" || name.starts_with("stm32") {
            println!("cargo:rustc-link-arg-bin={name}=-Tdefmt.x");
        }
    }
}

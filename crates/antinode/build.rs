//! Tells the core which instructions the target has: stable Rust does not show ARM's target features.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rustc-check-cfg=cfg(has_dsp, has_vsqrt)");
    let target = std::env::var("TARGET").unwrap_or_default();
    if target.starts_with("thumbv7em") {
        println!("cargo:rustc-cfg=has_dsp");
    }
    if target == "thumbv7em-none-eabihf" || target == "thumbv8m.main-none-eabihf" {
        println!("cargo:rustc-cfg=has_vsqrt");
    }
}

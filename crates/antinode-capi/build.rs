//! Sets the shared library's soname.

use std::env;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    // Before 1.0 every minor version may change the ABI.
    if env::var("CARGO_CFG_TARGET_OS").is_ok_and(|os| os == "linux") {
        let part = |name| env::var(name).expect("cargo sets it");
        let (major, minor) = (
            part("CARGO_PKG_VERSION_MAJOR"),
            part("CARGO_PKG_VERSION_MINOR"),
        );
        println!("cargo:rustc-cdylib-link-arg=-Wl,-soname,libantinode.so.{major}.{minor}");
    }
}

//! Sets the shared library's soname, and what it needs.

use std::env;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    // Of the C library it takes only memory functions. A loader that does not know this may relocate it first, and crash.
    if env::var_os("CARGO_CFG_UNIX").is_some() {
        println!("cargo:rustc-cdylib-link-arg=-lc");
    }
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

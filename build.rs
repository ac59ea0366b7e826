//! Gives the shared library its SONAME: while the version is 0.x, major and minor are the interface's.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    let has_soname = std::env::var("CARGO_CFG_TARGET_OS").is_ok_and(|os| os == "linux");
    if has_soname {
        let version = env!("CARGO_PKG_VERSION_MAJOR").to_string() + "." + env!("CARGO_PKG_VERSION_MINOR");
        println!("cargo:rustc-cdylib-link-arg=-Wl,-soname,libquadrel.so.{version}");
    }
}

//! Sets the cfg `unoptimized` if the library is compiled with optimization level 0. There each
//! vector operation is a chain of calls, so kernels compute one lane at a time (`Level::vectors`).

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-check-cfg=cfg(unoptimized)");
    if std::env::var("OPT_LEVEL").is_ok_and(|level| level == "0") {
        println!("cargo::rustc-cfg=unoptimized");
    }
}

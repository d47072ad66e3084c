//! Tells the library whether it is compiled without optimization: then a vector operation is a
//! chain of calls, and kernels compute one lane (`Level::vectors`).

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-check-cfg=cfg(unoptimized)");
    if std::env::var("OPT_LEVEL").is_ok_and(|level| level == "0") {
        println!("cargo::rustc-cfg=unoptimized");
    }
}

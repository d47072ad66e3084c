//! Checks that the rivals are compiled without assertions, as their authors release them.
//!
//! The crates around Box2D and Box3D compile the C code without `NDEBUG`, with all assertions. The
//! file `.cargo/config.toml` of `impinge-compare` therefore sets `CFLAGS`, unless it is already
//! set.

fn main() {
    println!("cargo::rerun-if-env-changed=CFLAGS");
    let has_c = ["BOX2D", "BOX3D"]
        .iter()
        .any(|name| std::env::var_os(format!("CARGO_FEATURE_{name}")).is_some());
    let flags = std::env::var("CFLAGS").unwrap_or_default();
    assert!(
        !has_c || flags.contains("-DNDEBUG"),
        "Box2D and Box3D would be raced with their assertions on: build in crates/impinge-compare, or \
         set CFLAGS='-O3 -DNDEBUG'"
    );
    #[cfg(feature = "coal")]
    coal();
}

/// Compiles the C++ calls of Coal. `COAL_PREFIX` lists the directories in which Coal, Boost and
/// Eigen are installed, by a wheel or a package.
#[cfg(feature = "coal")]
fn coal() {
    println!("cargo::rerun-if-env-changed=COAL_PREFIX");
    println!("cargo::rerun-if-changed=src/coal.cpp");
    let prefixes = std::env::var_os("COAL_PREFIX").expect(
        "COAL_PREFIX names the directories, separated by colons, with include and lib of Coal, Boost and Eigen",
    );
    let mut build = cc::Build::new();
    build.cpp(true).std("c++17").flag("-O3").define("NDEBUG", None).warnings(false);
    for prefix in std::env::split_paths(&prefixes) {
        build.include(prefix.join("include")).include(prefix.join("include/eigen3"));
        println!("cargo::rustc-link-search=native={}", prefix.join("lib").display());
    }
    build.file("src/coal.cpp").compile("impinge_coal");
    println!("cargo::rustc-link-lib=dylib=coal");
}

//! Sees to it that rivals run as their authors release them.
//!
//! The crates around Box2D and Box3D compile the C code without `NDEBUG`, with all assertions. The
//! file `.cargo/config.toml` of `impinge-compare` sets the flags where nobody else does.

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
}

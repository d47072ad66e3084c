//! Builds the engine of the page as a WebAssembly module and compresses it, if the feature `page`
//! is enabled.

#[cfg(feature = "page")]
mod engine {
    use std::io::Write;
    use std::path::{Path, PathBuf};
    use std::process::Command;
    use std::{env, fs};

    /// The environment variable for the path of a compiled module. If it is set, that module is
    /// embedded and none is built.
    const READY: &str = "IMPINGE_PAGE_MODULE";

    const TARGET: &str = "wasm32-unknown-unknown";

    /// Writes the compressed module as `page.wasm.gz` into the output folder of the build script.
    pub(super) fn embed() -> Result<(), String> {
        println!("cargo::rerun-if-env-changed={READY}");
        let folder = variable("OUT_DIR")?;
        let module = match env::var_os(READY) {
            Some(path) => PathBuf::from(path),
            None => build(&folder.join("engine"))?,
        };
        println!("cargo::rerun-if-changed={}", module.display());
        let bytes = fs::read(&module).map_err(|error| format!("{}: {error}", module.display()))?;
        let file = fs::File::create(folder.join("page.wasm.gz"));
        let level = flate2::Compression::best();
        let mut encoder = flate2::write::GzEncoder::new(file.map_err(text)?, level);
        encoder.write_all(&bytes).and_then(|()| encoder.finish()).map(drop).map_err(text)
    }

    fn text(error: impl std::fmt::Display) -> String {
        error.to_string()
    }

    fn variable(name: &str) -> Result<PathBuf, String> {
        env::var_os(name).map(PathBuf::from).ok_or_else(|| format!("cargo does not set {name}"))
    }

    /// Builds the engine with the target folder `folder`, since the outer cargo holds the lock of
    /// the default target folder. Returns the path of the module.
    fn build(folder: &Path) -> Result<PathBuf, String> {
        let crates = variable("CARGO_MANIFEST_DIR")?.join("..");
        for name in
            ["impinge", "impinge-page", "impinge-record", "impinge-samples", "impinge-scenes"]
        {
            println!("cargo::rerun-if-changed={}", crates.join(name).join("src").display());
        }
        let mut cargo = Command::new(variable("CARGO")?);
        cargo.current_dir(&crates);
        cargo.args(["build", "--profile", "page", "-p", "impinge-page", "--lib"]);
        cargo.args(["--target", TARGET, "--target-dir"]).arg(folder);
        // The flags and the compiler wrappers of the outer build do not apply to the engine.
        for name in
            ["CARGO_ENCODED_RUSTFLAGS", "RUSTC_WRAPPER", "RUSTC_WORKSPACE_WRAPPER", "CLIPPY_ARGS"]
        {
            cargo.env_remove(name);
        }
        cargo.env("RUSTFLAGS", "-C target-feature=+simd128");
        let status = cargo.status().map_err(text)?;
        if !status.success() {
            return Err(format!(
                "the engine of the page was not built. It needs the target {TARGET} \
                 (rustup target add {TARGET}). With {READY}=FILE that module is taken, and none is built."
            ));
        }
        Ok(folder.join(TARGET).join("page").join("impinge_page.wasm"))
    }
}

fn main() -> Result<(), String> {
    println!("cargo::rerun-if-changed=build.rs");
    #[cfg(feature = "page")]
    engine::embed()?;
    Ok(())
}

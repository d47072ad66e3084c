//! Tests the layering of the modules and the rules for sources, by reading the sources.
//!
//! The modules form layers, which are called floors. A module imports only from lower floors, or
//! from itself. There are three exceptions: lower floors reach higher ones through `tables/`,
//! `lib.rs` declares all modules, and tests may import anything.

use std::fs;
use std::path::{Path, PathBuf};

/// Modules by floor, the lowest floor first. Modules of one floor do not import each other.
const FLOORS: [&[&str]; 13] = [
    &["chunks", "generation", "journal", "math", "memory"],
    &["bounding_volume", "pairs"],
    &["bvh"],
    &["partitioning"],
    &["shape"],
    &["convex", "transformation", "procedural"],
    &["collide"],
    &["query"],
    &["broad_phase", "narrow_phase"],
    &["batch"],
    &["checker", "world"],
    &["debug_render"],
    &["dim2", "dim3"],
];

struct Source {
    /// Path below `src`.
    path: PathBuf,
    /// Top-level module of the file.
    module: String,
    lines: usize,
    /// Lines that are neither comments nor part of the test module at the end.
    code: Vec<String>,
}

/// Returns all source files except those that contain only tests.
fn sources() -> Vec<Source> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let (mut folders, mut sources) = (vec![root.clone()], Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                sources.push(source(&root, &path));
            }
        }
    }
    sources.retain(|source| !source.path.to_string_lossy().contains("tests"));
    assert!(sources.len() > 50, "the sources were found");
    sources
}

fn source(root: &Path, path: &Path) -> Source {
    let text = fs::read_to_string(path).expect("a text");
    let foot = text.find("#[cfg(test)]\nmod tests {").unwrap_or(text.len());
    let code = text[..foot].lines().filter(|line| !line.trim_start().starts_with("//"));
    let path = path.strip_prefix(root).expect("below").to_owned();
    let first = path.iter().next().expect("a name").to_string_lossy();
    Source {
        module: first.trim_end_matches(".rs").to_owned(),
        lines: text.lines().count(),
        code: code.map(str::to_owned).collect(),
        path,
    }
}

fn floor(module: &str) -> Option<usize> {
    FLOORS.iter().position(|floor| floor.contains(&module))
}

/// Iterates over the top-level modules that follow `crate::` in a line of code.
fn named(line: &str) -> impl Iterator<Item = &str> {
    let ends = |c: char| !c.is_alphanumeric() && c != '_';
    line.split("crate::").skip(1).filter_map(move |rest| rest.split(ends).next())
}

#[test]
fn modules_import_only_from_floors_below() {
    let mut found = Vec::new();
    for source in
        sources().iter().filter(|s| !["lib", "tables", "guide"].contains(&s.module.as_str()))
    {
        let own = floor(&source.module);
        assert!(own.is_some(), "{} stands on no floor", source.path.display());
        for line in &source.code {
            let upward = |other: &&str| *other != source.module && floor(other) >= own;
            // `tables` is on no floor, so every module may use it.
            for other in named(line).filter(|other| floor(other).is_some()).filter(upward) {
                found.push(format!("{} uses {other}: {line}", source.path.display()));
            }
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn rules_of_the_house() {
    let mut found = Vec::new();
    for source in sources() {
        let name = source.path.display();
        if source.lines > 500 {
            found.push(format!("{name} has {} lines", source.lines));
        }
        for line in &source.code {
            let asks_dimension = ["if D ==", "if D >", "if D <", "match D "];
            let forbidden = asks_dimension.iter().any(|words| line.contains(words))
                || line.contains(".unwrap()")
                || (line.contains("nalgebra") && source.module != "math")
                // `dispatch` also compiles each kernel for its fallback without SIMD, which takes
                // very long.
                || line.contains("fearless_simd::dispatch")
                || (line.contains("fearless_simd")
                    && !["math", "bvh"].contains(&source.module.as_str()));
            if forbidden {
                found.push(format!("{name}: {line}"));
            }
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

//! The order of the modules and the rules of the house, read off the sources.
//!
//! A module imports only from floors below its own, or from itself. `tables/` is the one hook that
//! reaches upwards, `lib.rs` names the modules, and tests may look anywhere.

use std::fs;
use std::path::{Path, PathBuf};

/// From the ground up.
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
    /// Below `src`.
    path: PathBuf,
    /// The module at the top that the file belongs to.
    module: String,
    lines: usize,
    /// The lines that are neither comments nor the tests at the foot.
    code: Vec<String>,
}

/// All files but the tests in files of their own.
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

/// The modules at the top that a line of code names.
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
            // The tables are on no floor: every module may reach the hook.
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
                // Kernels that are compiled for its fallback take compilers forever.
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

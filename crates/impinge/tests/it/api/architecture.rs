//! Tests that `ARCHITECTURE.md` and `CONTRIBUTING.md` name only files that exist, and that
//! `ARCHITECTURE.md` stays short.

use std::fs;
use std::path::{Path, PathBuf};

/// The largest number of lines of `ARCHITECTURE.md`, so that contributors read all of it.
const MAX_LINES: usize = 150;

/// Returns the root folder of the repository.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn document(name: &str) -> String {
    fs::read_to_string(root().join(name)).expect("a text at the root of the repository")
}

/// Returns the words in backquotes that name a file or folder: those that end in `.rs`, `.md` or
/// `/`. Skips blocks of code, because these may name files that a command writes.
fn paths(text: &str) -> Vec<&str> {
    let prose = text.split("```").step_by(2);
    let quoted = prose.flat_map(|prose| prose.split('`').skip(1).step_by(2));
    let is_path = |word: &&str| {
        let ends = [".rs", ".md", "/"].iter().any(|end| word.ends_with(end));
        ends && !word.contains(char::is_whitespace)
    };
    quoted.filter(is_path).collect()
}

/// Returns `true` if a folder has a file of this name, at any depth.
fn holds(folder: &Path, name: &str) -> bool {
    let mut entries =
        fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    entries.any(|path| path.ends_with(name) || path.is_dir() && holds(&path, name))
}

/// Returns `true` if a path exists below the root or below the library's sources. A bare file name
/// may belong to any source.
fn exists(path: &str) -> bool {
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let is_there = root().join(path).exists() || sources.join(path).exists();
    is_there || !path.contains('/') && holds(&sources, path)
}

#[test]
fn architecture_is_short() {
    let lines = document("ARCHITECTURE.md").lines().count();
    assert!(lines <= MAX_LINES, "{lines} lines");
}

#[test]
fn architecture_and_contributing_name_what_exists() {
    for name in ["ARCHITECTURE.md", "CONTRIBUTING.md"] {
        let text = document(name);
        let paths = paths(&text);
        assert!(paths.len() > 10, "the paths of {name} were found");
        let missing: Vec<_> = paths.into_iter().filter(|path| !exists(path)).collect();
        assert!(missing.is_empty(), "{name} names {missing:?}");
    }
}

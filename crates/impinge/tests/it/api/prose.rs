//! Tests that comments have subjects: at most a few of their lines begin with a noun clause ("What
//! is …", "Of those that …", "The same of …"), which hides the subject of a sentence.

use std::fs;
use std::path::{Path, PathBuf};

/// Words with which such a clause begins.
const OPENINGS: [&str; 5] = ["What", "Of", "Those", "That", "The same"];
/// Number of lines in the whole project that may begin with these words: questions, and lines in
/// the middle of a sentence.
const MOST: usize = 60;

/// Collects the Rust sources below a folder; skips build output.
fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let is_built = path.ends_with("target") || path.ends_with("node_modules");
        if path.is_dir() && !is_built {
            sources(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

/// Returns `true` if a line is a comment that begins with one of the openings.
fn has_opening(line: &str) -> bool {
    let Some(comment) = line.trim_start().strip_prefix("//") else { return false };
    let comment = comment.trim_start_matches(['/', '!']).trim_start();
    OPENINGS.iter().any(|opening| {
        let rest = comment.strip_prefix(opening);
        rest.is_some_and(|rest| !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_'))
    })
}

#[test]
fn openings_of_comments_are_told_apart() {
    for line in ["// What is near", "    /// Of two shapes", "//! The same in 2D", "//That of a"] {
        assert!(has_opening(line), "{line}");
    }
    for line in ["/// Whatever moves", "// Often", "let of = 1; // Of", "/// Offers", "// Then"] {
        assert!(!has_opening(line), "{line}");
    }
}

#[test]
fn comments_begin_with_a_subject() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut files = Vec::new();
    for folder in ["crates", "fuzz", "integrations", "python/src"] {
        sources(&root.join(folder), &mut files);
    }
    assert!(files.len() > 500, "the sources were found");
    let mut found = Vec::new();
    for file in &files {
        let text = fs::read_to_string(file).expect("a text");
        let lines = text.lines().zip(1..).filter(|(line, _)| has_opening(line));
        found.extend(lines.map(|(line, number)| format!("{}:{number}: {line}", file.display())));
    }
    let list = found.join("\n");
    assert!(found.len() <= MOST, "{} comments begin with a noun clause:\n{list}", found.len());
}

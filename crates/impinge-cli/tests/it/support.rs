//! Runs the command in a temporary folder, and captures its output.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::Value;
use tempfile::TempDir;

/// A temporary folder with a copy of the folder `scenes`, in which the command runs.
pub(crate) struct Desk(TempDir);

/// A page with one line for each of its parts. The real page is part of the command only with the
/// feature `page`.
const PAGE: [(&str, &str); 4] = [
    ("page.html", "{{TITLE}}\n{{SCENE}}\n{{RECORDING}}\n{{STYLE}}\n{{SCRIPT}}\n{{WASM}}\n"),
    ("page.css", "style"),
    ("page.js", "script"),
    ("page.wasm.gz", "module"),
];

/// The output of a run of the command.
#[derive(Debug)]
pub(crate) struct Ran {
    pub(crate) code: i32,
    pub(crate) out: String,
    pub(crate) err: String,
}

impl Desk {
    pub(crate) fn new() -> Self {
        let folder = TempDir::new().expect("a temporary folder");
        for entry in fs::read_dir(scenes()).expect("the scenes") {
            let path = entry.expect("an entry").path();
            let name = path.file_name().expect("a name");
            fs::copy(&path, folder.path().join(name)).expect("a copy");
        }
        let desk = Self(folder);
        fs::create_dir(desk.path("page")).expect("a folder");
        for (name, text) in PAGE {
            desk.write(&format!("page/{name}"), text);
        }
        desk
    }

    /// Creates a folder that also contains `balls.implog`, a recording of 30 steps of `balls.json`.
    ///
    /// The left ball moves by 2 per second, so the gap of 0.5 is closed after a quarter of a
    /// second, or 15 steps.
    pub(crate) fn recorded() -> Self {
        let desk = Self::new();
        let ran = desk.run("record balls.json -o balls.implog --steps 30");
        assert_eq!((ran.code, ran.err.as_str()), (0, ""), "{ran:?}");
        desk
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, text: impl AsRef<[u8]>) {
        fs::write(self.path(name), text).expect("a file");
    }

    /// Runs `impinge` with arguments separated by spaces.
    pub(crate) fn run(&self, arguments: &str) -> Ran {
        self.run_with(arguments, b"")
    }

    /// Runs `impinge` with arguments separated by spaces, and with `input` on standard input.
    pub(crate) fn run_with(&self, arguments: &str, input: &[u8]) -> Ran {
        let mut command = self.command();
        let pipes = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = pipes.args(arguments.split_whitespace()).spawn().expect("the command");
        // The command may end before it has read all of its input.
        let _ = child.stdin.take().expect("a pipe").write_all(input);
        let output = child.wait_with_output().expect("an end");
        let text = |bytes| String::from_utf8(bytes).expect("text");
        let code = output.status.code().expect("no signal");
        Ran { code, out: text(output.stdout), err: text(output.stderr) }
    }

    /// Returns the command in this folder, without arguments.
    pub(crate) fn command(&self) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_impinge"));
        command.current_dir(self.0.path()).env_remove("CLICOLOR_FORCE");
        command.env("IMPINGE_PAGE", self.path("page"));
        command
    }

    /// Runs `impinge` with `--json`, asserts the exit code, and returns the report.
    pub(crate) fn json(&self, arguments: &str, code: i32) -> Value {
        let ran = self.run(&format!("{arguments} --json"));
        assert_eq!(ran.code, code, "{arguments}: {ran:?}");
        assert_eq!(ran.err, "", "{arguments}");
        serde_json::from_str(&ran.out).expect("JSON")
    }
}

/// Returns the folder of the crate.
pub(crate) fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn scenes() -> PathBuf {
    root().join("scenes")
}

/// Returns the numbers of a JSON array.
pub(crate) fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().expect("a list");
    list.iter().map(|number| number.as_f64().expect("a number")).collect()
}

/// Returns `true` if a number equals `expected` up to 1e-14, a few units in the last place of an
/// `f64` of size 1.
pub(crate) fn is_close(value: &Value, expected: f64) -> bool {
    value.as_f64().is_some_and(|value| (value - expected).abs() < 1e-14)
}

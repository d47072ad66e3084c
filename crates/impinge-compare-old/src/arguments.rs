//! Parses the command line.

/// The selected scenes, their sizes, and the number of steps and runs.
#[derive(Clone, Debug)]
pub struct Arguments {
    /// A text that the name of a case must contain, such as `pile` or `3D`.
    pub case: String,
    /// Whether the name of a case must be equal to `case`.
    pub is_exact: bool,
    /// The requested number of objects. Scenes of large objects have a twentieth or a hundredth of
    /// this number, some scenes ten times as many.
    pub objects: usize,
    /// The number of steps of a run.
    pub steps: u32,
    /// The number of runs; the time of a step is its minimum over the runs.
    pub runs: usize,
    /// Whether pairs keep their contacts until they have moved by half of the prediction.
    pub is_reusing: bool,
}

impl Arguments {
    /// Parses the command line; prints the usage and exits on an error.
    pub fn of_command_line() -> Self {
        let mut arguments = Self {
            case: String::new(),
            is_exact: false,
            objects: 10_000,
            steps: 60,
            runs: 1,
            is_reusing: false,
        };
        let mut words = std::env::args().skip(1);
        while let Some(word) = words.next() {
            let mut value = || words.next().unwrap_or_else(|| usage(&word));
            match word.as_str() {
                "--case" => arguments.case = value(),
                "--exact" => (arguments.case, arguments.is_exact) = (value(), true),
                "--objects" => arguments.objects = number(&value()),
                "--steps" => arguments.steps = number(&value()),
                "--runs" => arguments.runs = number(&value()),
                "--reusing" => arguments.is_reusing = true,
                _ => usage(&word),
            }
        }
        arguments
    }

    /// Returns `true` if a case is to run.
    pub fn wants(&self, name: &str) -> bool {
        if self.is_exact { name == self.case } else { name.contains(&self.case) }
    }
}

fn number<T: std::str::FromStr>(word: &str) -> T {
    word.parse().unwrap_or_else(|_| usage(word))
}

/// Prints the usage and exits with code 2.
fn usage(word: &str) -> ! {
    eprintln!("{word} is not understood");
    eprintln!(
        "usage: impinge-compare-old [--case TEXT | --exact NAME] [--objects N] [--steps N] [--runs N] [--reusing]"
    );
    std::process::exit(2)
}

//! What the command line asks for.

/// Which scenes to run and how much of them.
#[derive(Clone, Debug)]
pub struct Arguments {
    /// What the words of a case have to contain, such as `pile`, or `3D`.
    pub case: String,
    /// Whether the name of a case has to be that text, instead of to contain it.
    pub is_exact: bool,
    /// How many objects there are in a scene of usual objects; those of large ones have a twentieth or a
    /// hundredth, those in which most rest ten times as many.
    pub objects: usize,
    /// How many steps make a run.
    pub steps: u32,
    /// How many runs; the time of a step is its minimum over the runs.
    pub runs: usize,
    /// Whether pairs keep their contacts until they have moved by half of the prediction.
    pub is_reusing: bool,
}

impl Arguments {
    /// Reads the words of the command line; ends the program if they are not understood.
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

    /// Whether a case is to run.
    pub fn wants(&self, name: &str) -> bool {
        if self.is_exact { name == self.case } else { name.contains(&self.case) }
    }
}

fn number<T: std::str::FromStr>(word: &str) -> T {
    word.parse().unwrap_or_else(|_| usage(word))
}

/// Says what is understood, and ends the program.
fn usage(word: &str) -> ! {
    eprintln!("{word} is not understood");
    eprintln!(
        "usage: impinge-compare-old [--case TEXT | --exact NAME] [--objects N] [--steps N] [--runs N] [--reusing]"
    );
    std::process::exit(2)
}

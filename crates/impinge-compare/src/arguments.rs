//! The command line.

/// The suites to run and their sizes.
#[derive(Clone, Debug)]
pub struct Arguments {
    /// The number of objects in scenes whose size is not part of the case, and its upper bound in
    /// other scenes.
    pub objects: usize,
    /// The lower bound of the number of objects, where the size is part of the case.
    pub least: usize,
    /// The number of steps or rounds of a run.
    pub steps: u32,
    /// In the suite `world`, the sum over a pair of the angular predictions in radians; only impinge
    /// supports them.
    pub angular: f64,
    /// The folder below `bench/`.
    pub machine: String,
    /// A text that the case must contain.
    pub case: String,
    /// A text that the name of a contender must contain.
    pub only: String,
    /// The requested suites.
    pub suites: Vec<String>,
}

impl Arguments {
    /// Parses the command line; ends the program on an error.
    pub fn of_command_line(known: &[&str]) -> Self {
        let mut arguments = Self::default();
        let mut words = std::env::args().skip(1);
        while let Some(word) = words.next() {
            let mut value = || words.next().unwrap_or_else(|| usage(&word, known));
            match word.as_str() {
                "--objects" => arguments.objects = parsed(&value(), known),
                "--from" => arguments.least = parsed(&value(), known),
                "--steps" => arguments.steps = parsed(&value(), known),
                "--angular" => arguments.angular = parsed(&value(), known),
                "--machine" => arguments.machine = value(),
                "--case" => arguments.case = value(),
                "--only" => arguments.only = value(),
                name if known.contains(&name) => arguments.suites.push(word),
                other => usage(other, known),
            }
        }
        if arguments.suites.is_empty() {
            usage("nothing", known);
        }
        arguments
    }

    /// Whether a suite is to run.
    pub fn wants_suite(&self, name: &str) -> bool {
        self.suites.iter().any(|wanted| wanted == "all" || wanted == name)
    }

    /// Whether a contender of this name is to run.
    pub fn wants_contender(&self, name: &str) -> bool {
        name.contains(&self.only)
    }

    /// Whether a case is to run.
    pub fn wants_case(&self, case: &str) -> bool {
        case.contains(&self.case)
    }

    /// Whether a case of this number of objects is to run.
    pub fn includes(&self, objects: usize) -> bool {
        (self.least..=self.objects).contains(&objects)
    }

    /// Whether impinge runs without rivals.
    pub fn is_alone(&self) -> bool {
        self.only == "impinge"
    }

    /// Whether all contenders run in all cases, with the default prediction.
    pub fn is_whole(&self) -> bool {
        self.only.is_empty() && self.case.is_empty() && self.least == 0 && self.angular == 0.0
    }
}

impl Default for Arguments {
    fn default() -> Self {
        Self {
            objects: 10_000,
            least: 0,
            steps: 100,
            angular: 0.0,
            machine: "local".to_owned(),
            case: String::new(),
            only: String::new(),
            suites: Vec::new(),
        }
    }
}

/// Parses a word; ends the program on an error.
fn parsed<T: std::str::FromStr>(word: &str, known: &[&str]) -> T {
    word.parse().unwrap_or_else(|_| usage(word, known))
}

/// Prints the usage, and ends the program.
pub fn usage(word: &str, suites: &[&str]) -> ! {
    eprintln!("{word} is not understood");
    eprintln!("usage: impinge-compare SUITE... [--objects N] [--from N] [--steps N]");
    eprintln!("                       [--machine NAME] [--only NAME] [--case TEXT]");
    eprintln!("                       [--angular RADIANS]");
    eprintln!("       impinge-compare accuracy [samples]");
    eprintln!("suites: {}", suites.join(" "));
    std::process::exit(2)
}

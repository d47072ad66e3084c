//! Parses the command line.

/// The suites to run, their sizes, and the selection of cases and contenders.
#[derive(Clone, Debug)]
pub struct Arguments {
    /// The number of objects of a scene. In suites whose cases have fixed sizes, the largest size
    /// that runs.
    pub objects: usize,
    /// In suites whose cases have fixed sizes, the smallest size that runs.
    pub least: usize,
    /// The number of steps or rounds of a run.
    pub steps: u32,
    /// The sum over a pair of the angular predictions, in radians, in the suite `world`. Only
    /// impinge supports angular predictions.
    pub angular: f64,
    /// The name of the machine: the folder below `bench/` to which tables are written.
    pub machine: String,
    /// A text that the name of a case must contain.
    pub case: String,
    /// A text that the name of a contender must contain.
    pub only: String,
    /// The names of the requested suites.
    pub suites: Vec<String>,
}

impl Arguments {
    /// Parses the command line. Prints the usage and exits on an error; `known` lists the suites.
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

    /// Returns `true` if a suite is to run.
    pub fn wants_suite(&self, name: &str) -> bool {
        self.suites.iter().any(|wanted| wanted == "all" || wanted == name)
    }

    /// Returns `true` if a contender of this name is to run.
    pub fn wants_contender(&self, name: &str) -> bool {
        name.contains(&self.only)
    }

    /// Returns `true` if a case is to run.
    pub fn wants_case(&self, case: &str) -> bool {
        case.contains(&self.case)
    }

    /// Returns `true` if a case with this number of objects is to run.
    pub fn includes(&self, objects: usize) -> bool {
        (self.least..=self.objects).contains(&objects)
    }

    /// Returns `true` if impinge runs without rivals.
    pub fn is_alone(&self) -> bool {
        self.only == "impinge"
    }

    /// Returns `true` if all contenders run in all cases with default settings, so that the table
    /// is complete.
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

/// Parses a word; prints the usage and exits on an error.
fn parsed<T: std::str::FromStr>(word: &str, known: &[&str]) -> T {
    word.parse().unwrap_or_else(|_| usage(word, known))
}

/// Prints the usage and exits with code 2.
pub fn usage(word: &str, suites: &[&str]) -> ! {
    eprintln!("{word} is not understood");
    eprintln!("usage: impinge-compare SUITE... [--objects N] [--from N] [--steps N]");
    eprintln!("                       [--machine NAME] [--only NAME] [--case TEXT]");
    eprintln!("                       [--angular RADIANS]");
    eprintln!("       impinge-compare accuracy [samples]");
    eprintln!("suites: {}", suites.join(" "));
    std::process::exit(2)
}

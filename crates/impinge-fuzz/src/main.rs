//! Runs the targets with random bytes, without `cargo fuzz`.
//!
//! `impinge-fuzz 10` runs each target for ten seconds, after its inputs in `regressions.txt`.
//! `impinge-fuzz 10 world ray` runs only the targets `world` and `ray`. The seed differs from run
//! to run and is printed; `SEED=7` sets it. An input that panics is reduced and printed.
//! `impinge-fuzz replay world 00ff` runs one input, which is a string of hexadecimal digits or the
//! name of a file. `impinge-fuzz reduce world 00ff` reduces it first.
#![forbid(unsafe_code)]
#![allow(clippy::print_stdout, reason = "findings are printed")]

use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::process::ExitCode;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use impinge_fuzz::{TARGETS, Target};

/// Inputs that once panicked: a target and hexadecimal digits per line, `#` before a comment.
const REGRESSIONS: &str = include_str!("../regressions.txt");

/// Random inputs have at least 8 bytes and less than 8 more than this number.
const MAX_BYTES: u64 = 512;

/// Inputs that take longer than this are printed.
const SLOW: Duration = Duration::from_secs(2);

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [mode, name, input] = &arguments[..] {
        match mode.as_str() {
            "replay" => return replay(name, input, false),
            "reduce" => return replay(name, input, true),
            _ => {}
        }
    }
    let seconds = arguments.first().and_then(|text| text.parse().ok()).unwrap_or(5);
    let names = arguments.get(1..).unwrap_or_default();
    let seed = seed();
    println!("seed {seed}");
    let mut failed = false;
    for (name, target) in TARGETS {
        if names.is_empty() || names.iter().any(|wanted| wanted == name) {
            failed |= !run(name, target, Duration::from_secs(seconds), seed);
        }
    }
    if failed { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

fn replay(name: &str, input: &str, is_reduced: bool) -> ExitCode {
    let target = TARGETS.iter().find(|(known, _)| *known == name);
    let data = std::fs::read(input).ok().or_else(|| from_digits(input));
    let (Some((_, target)), Some(mut data)) = (target, data) else {
        println!("no target {name}, or no input {input}");
        return ExitCode::FAILURE;
    };
    if is_reduced {
        data = without_messages(|| reduced(*target, data));
        println!("{}", digits(&data));
    }
    target(&data);
    ExitCode::SUCCESS
}

/// Replays the regressions of a target, then runs it on random inputs for `time`. Returns `false`
/// if the target panicked.
fn run(name: &str, target: Target, time: Duration, seed: u64) -> bool {
    let known = regressions(name);
    let (start, mut random) = (Instant::now(), Random(seed));
    let (mut runs, mut slowest) = (0, Duration::ZERO);
    let mut inputs = known.clone();
    while !inputs.is_empty() || start.elapsed() < time {
        let data = inputs.pop().unwrap_or_else(|| random.input(&known));
        let begin = Instant::now();
        if without_messages(|| panics(target, &data)) {
            report(name, target, data);
            return false;
        }
        let elapsed = begin.elapsed();
        if elapsed > SLOW {
            println!("{name}: {elapsed:?} for {}", digits(&data));
        }
        slowest = slowest.max(elapsed);
        runs += 1;
    }
    println!("{name}: {runs} runs, the slowest {slowest:?}");
    true
}

/// Prints an input that panics, reduced, and the message of the panic.
fn report(name: &str, target: Target, data: Vec<u8>) {
    println!("{name}: panics on {}", digits(&data));
    let data = without_messages(|| reduced(target, data));
    println!("{name}: reduced {}", digits(&data));
    let _ = catch_unwind(|| target(&data));
}

fn regressions(name: &str) -> Vec<Vec<u8>> {
    let lines = REGRESSIONS.lines().map(|line| line.split('#').next().unwrap_or_default().trim());
    let input = |line: &str| match line.split_once(' ') {
        Some((target, input)) if target == name => from_digits(input.trim()),
        _ => None,
    };
    lines.filter_map(input).collect()
}

/// Returns the seed in the variable `SEED`; without it, a seed from the current time.
fn seed() -> u64 {
    let given = std::env::var("SEED").ok().and_then(|text| text.parse().ok());
    let now = || SystemTime::now().duration_since(UNIX_EPOCH).map_or(1, |time| time.as_micros());
    given.unwrap_or_else(|| u64::try_from(now() % 1_000_000_000).unwrap_or(1))
}

/// `SplitMix64`: Steele, Lea, Flood, "Fast Splittable Pseudorandom Number Generators" (2014).
struct Random(u64);

impl Random {
    const fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// Returns a number below `bound`.
    fn below(&mut self, bound: usize) -> usize {
        usize::try_from(self.next() % bound as u64).unwrap_or_default()
    }

    /// Returns a random byte. At least a quarter of all bytes are below 32, since small bytes give
    /// simple shapes and poses.
    const fn byte(&mut self) -> u8 {
        let [first, second, ..] = self.next().to_le_bytes();
        if first < 64 { second & 31 } else { second }
    }

    /// Returns random bytes; in one of eight cases the bytes of a regression with one to four bytes
    /// changed.
    fn input(&mut self, known: &[Vec<u8>]) -> Vec<u8> {
        if known.is_empty() || self.below(8) > 0 {
            return self.bytes();
        }
        let mut data = known[self.below(known.len())].clone();
        for _ in 0..=self.below(4) {
            if data.is_empty() {
                break;
            }
            let index = self.below(data.len());
            data[index] = self.byte();
        }
        data
    }

    /// Returns bytes of a random length; short lengths are more frequent.
    fn bytes(&mut self) -> Vec<u8> {
        let length = self.next() % (self.next() % MAX_BYTES + 1) + 8;
        (0..length).map(|_| self.byte()).collect()
    }
}

fn panics(target: Target, data: &[u8]) -> bool {
    catch_unwind(AssertUnwindSafe(|| target(data))).is_err()
}

/// Calls `act` with the messages of panics suppressed.
fn without_messages<A>(act: impl FnOnce() -> A) -> A {
    let hook = take_hook();
    set_hook(Box::new(|_| {}));
    let answer = act();
    set_hook(hook);
    answer
}

/// Returns a shorter or simpler input that panics too: with bytes removed or set to zero.
fn reduced(target: Target, mut data: Vec<u8>) -> Vec<u8> {
    for _ in 0..4 {
        let before = data.clone();
        for length in [256, 128, 64, 32, 16, 8, 4, 2, 1] {
            reduce_by(length, target, &mut data);
        }
        if data == before {
            break;
        }
    }
    data
}

/// Removes or zeroes runs of `length` bytes if the input still panics.
fn reduce_by(length: usize, target: Target, data: &mut Vec<u8>) {
    let mut start = 0;
    while start < data.len() {
        let end = (start + length).min(data.len());
        let mut shorter = data.clone();
        shorter.drain(start..end);
        if panics(target, &shorter) {
            *data = shorter;
            continue;
        }
        let mut plain = data.clone();
        plain[start..end].fill(0);
        if plain != *data && panics(target, &plain) {
            *data = plain;
        }
        start = end;
    }
}

fn digits(data: &[u8]) -> String {
    data.iter().map(|byte| format!("{byte:02x}")).collect()
}

fn from_digits(text: &str) -> Option<Vec<u8>> {
    let byte = |index: usize| u8::from_str_radix(text.get(index..index + 2)?, 16).ok();
    (0..text.len()).step_by(2).map(byte).collect()
}

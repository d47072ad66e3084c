//! Feeds pseudo-random bytes to the targets, without `cargo fuzz`.
//!
//! `smoke 10` runs each target for ten seconds, `smoke 10 world ray` these two, and `smoke replay world
//! 00ff…` (or a file's name in place of the digits) one input. An input that panics is made smaller and printed.

use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::process::ExitCode;
use std::time::{Duration, Instant};

use impinge_fuzz::TARGETS;

type Target = fn(&[u8]);

/// The longest input.
const MOST_BYTES: u64 = 512;

/// An input that takes longer counts as a hang.
const PATIENCE: Duration = Duration::from_secs(2);

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [first, name, input] = &arguments[..]
        && first == "replay"
    {
        return replay(name, input);
    }
    let seconds = arguments.first().and_then(|text| text.parse().ok()).unwrap_or(5);
    let names = arguments.get(1..).unwrap_or_default();
    let mut failed = false;
    for (name, target) in TARGETS {
        if names.is_empty() || names.iter().any(|wanted| wanted == name) {
            failed |= !run(name, target, Duration::from_secs(seconds));
        }
    }
    if failed { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

fn replay(name: &str, input: &str) -> ExitCode {
    let target = TARGETS.iter().find(|(known, _)| *known == name);
    let data = std::fs::read(input).ok().or_else(|| from_digits(input));
    let (Some((_, target)), Some(data)) = (target, data) else {
        println!("no target {name}, or no input {input}");
        return ExitCode::FAILURE;
    };
    if std::env::var_os("SHRINK").is_some() {
        silently(|| println!("{}", digits(&smaller(*target, data.clone()))));
    }
    target(&data);
    ExitCode::SUCCESS
}

/// Runs a target for a time; `false` if it panicked.
fn run(name: &str, target: Target, time: Duration) -> bool {
    let (start, mut number, mut runs, mut slowest) =
        (Instant::now(), seed(), 0_u64, Duration::ZERO);
    while start.elapsed() < time {
        let data = input(&mut number);
        let begun = Instant::now();
        if silently(|| panics(target, &data)) {
            let data = silently(|| smaller(target, data));
            println!("{name}: panics on {}", digits(&data));
            let _ = catch_unwind(|| target(&data));
            return false;
        }
        if begun.elapsed() > PATIENCE {
            println!("{name}: {:?} for {}", begun.elapsed(), digits(&data));
        }
        slowest = slowest.max(begun.elapsed());
        runs += 1;
    }
    println!("{name}: {runs} runs, the slowest {slowest:?}");
    true
}

fn seed() -> u64 {
    std::env::var("SEED").ok().and_then(|text| text.parse().ok()).unwrap_or(1)
        * 0x9e37_79b9_7f4a_7c15
}

/// Bytes of a length that is short more often than long; small bytes, which most choices understand,
/// are frequent.
fn input(number: &mut u64) -> Vec<u8> {
    let length = next(number) % (next(number) % MOST_BYTES + 1) + 8;
    let byte = |number: &mut u64| {
        let drawn = next(number);
        (if drawn % 4 == 0 { drawn >> 32 & 0x1f } else { drawn >> 32 }) as u8
    };
    (0..length).map(|_| byte(number)).collect()
}

/// The next number of a linear congruential generator, its high bits mixed in (Steele and Vigna,
/// 2022).
fn next(number: &mut u64) -> u64 {
    *number = number.wrapping_mul(0xd134_2543_de82_ef95).wrapping_add(1);
    (*number ^ *number >> 32).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 8
}

fn panics(target: Target, data: &[u8]) -> bool {
    catch_unwind(AssertUnwindSafe(|| target(data))).is_err()
}

/// Without the messages of panics.
fn silently<A>(act: impl FnOnce() -> A) -> A {
    let hook = take_hook();
    set_hook(Box::new(|_| {}));
    let answer = act();
    set_hook(hook);
    answer
}

/// An input that panics too: cut off, with bytes taken out, or zeros put in.
fn smaller(target: Target, mut data: Vec<u8>) -> Vec<u8> {
    for _ in 0..4 {
        let before = data.clone();
        for length in [256, 128, 64, 32, 16, 8, 4, 2, 1] {
            let mut start = 0;
            while start < data.len() {
                let end = (start + length).min(data.len());
                let mut shorter = data.clone();
                shorter.drain(start..end);
                let mut plain = data.clone();
                plain[start..end].fill(0);
                if panics(target, &shorter) {
                    data = shorter;
                } else {
                    if plain != data && panics(target, &plain) {
                        data = plain;
                    }
                    start = end;
                }
            }
        }
        if data == before {
            break;
        }
    }
    data
}

fn digits(data: &[u8]) -> String {
    data.iter().map(|byte| format!("{byte:02x}")).collect()
}

fn from_digits(text: &str) -> Option<Vec<u8>> {
    let byte = |index: usize| u8::from_str_radix(text.get(index..index + 2)?, 16).ok();
    (0..text.len()).step_by(2).map(byte).collect()
}

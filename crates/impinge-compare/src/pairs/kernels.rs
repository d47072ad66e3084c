//! Runs one contender in one case under an instruction counter, such as callgrind.

use super::question::{Contender, Question};
use super::regime::PAIRS;

/// Runs the contender of this name for `rounds` rounds of a case, and prints the number of calls. A
/// warm-up round before them is not counted.
pub fn count(
    case: &str,
    question: Question,
    name: &str,
    contenders: &mut [Box<dyn Contender>],
    rounds: usize,
) {
    let is_meant = |one: &&mut Box<dyn Contender>| one.treats(question) && one.name() == name;
    for contender in contenders.iter_mut().filter(is_meant) {
        contender.reset(question);
        contender.ask(question);
        for _ in 0..rounds {
            counted(&mut **contender, question);
        }
        println!("{case}, {name}: {} calls", rounds * PAIRS);
    }
}

/// The function whose instructions the counter collects; it must not be inlined.
#[inline(never)]
fn counted(contender: &mut dyn Contender, question: Question) {
    contender.ask(question);
}

//! Instructions per call, for an instruction counter: the rounds of one contender in one case.

use super::question::{Contender, Question};
use super::regime::PAIRS;

/// How many rounds are counted.
const ROUNDS: usize = 8;

/// Runs every contender whose name is `only` in the cases of one question that are selected, and says
/// how many calls there were.
pub fn count(case: &str, question: Question, only: &str, contenders: &mut [Box<dyn Contender>]) {
    let is_meant = |one: &&mut Box<dyn Contender>| one.treats(question) && one.name() == only;
    for contender in contenders.iter_mut().filter(is_meant) {
        contender.reset(question);
        contender.ask(question);
        for _ in 0..ROUNDS {
            counted(&mut **contender, question);
        }
        println!("{case}, {}: {} calls", contender.name(), ROUNDS * PAIRS);
    }
}

/// The one function whose instructions count.
#[inline(never)]
fn counted(contender: &mut dyn Contender, question: Question) {
    contender.ask(question);
}

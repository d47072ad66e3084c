//! Runs the contenders in one case and compares their results.

use std::panic::{AssertUnwindSafe, catch_unwind};

use super::question::{Answer, Contender, Question};
use super::regime::{PAIRS, Regime};
use crate::measure::{Times, in_turn, timed};
use crate::table::Row;

/// The approximate time limit of all rounds of the slowest contender, in nanoseconds.
const LONGEST: f64 = 3e7;

/// The minimum number of timed rounds.
const FEWEST: usize = 2;

/// Runs all contenders that support the query. Returns a row for each contender that supports every
/// pair of the case, with the number of results that differ from those of the first such contender.
pub fn race(
    case: &str,
    question: Question,
    regime: Regime,
    contenders: &mut [Box<dyn Contender>],
    rounds: usize,
) -> Vec<Row> {
    let mut able = Vec::new();
    let mut slowest = 0.0_f64;
    for contender in contenders.iter_mut().filter(|contender| contender.treats(question)) {
        if let Some(time) = tried(&mut **contender, question) {
            slowest = slowest.max(time);
            able.push(contender);
        }
    }
    let rounds = rounds.min((LONGEST / slowest) as usize).max(FEWEST);
    let mut asks: Vec<_> = able.iter_mut().map(|one| || one.ask(question)).collect();
    let mut turns: Vec<&mut dyn FnMut()> = Vec::new();
    turns.extend(asks.iter_mut().map(|ask| ask as &mut dyn FnMut()));
    let times = in_turn(rounds, PAIRS, &mut turns);
    drop(asks);
    let answers: Vec<_> = able.iter().map(|one| one.answers(question)).collect();
    let named = able.iter().zip(times).zip(&answers);
    let row = |(name, times): (&str, Times), found: &Vec<Answer>| Row {
        case: case.to_owned(),
        contender: name.to_owned(),
        answers: found.iter().filter(|answer| answer.is_some()).count(),
        differ: question.differences(&answers[0], found, regime.distance()),
        times,
    };
    let rows = |((one, times), found): ((&&mut Box<dyn Contender>, Times), &Vec<Answer>)| {
        let part = one.part().filter(|_| question.is_manifold());
        [Some((one.name(), times)), part]
            .into_iter()
            .flatten()
            .map(|timed| row(timed, found))
            .collect::<Vec<_>>()
    };
    named.flat_map(rows).collect()
}

/// Returns the time of the first round of a contender; `None` if it has no algorithm for the pair,
/// or panics. If it does not panic, the contender is reset afterwards.
fn tried(contender: &mut dyn Contender, question: Question) -> Option<f64> {
    let attempt = AssertUnwindSafe(|| {
        contender.reset(question);
        let (time, ()) = timed(|| contender.ask(question));
        let is_able = contender.answers(question).iter().all(|answer| answer.is_supported());
        contender.reset(question);
        is_able.then_some(time)
    });
    catch_unwind(attempt).ok().flatten()
}

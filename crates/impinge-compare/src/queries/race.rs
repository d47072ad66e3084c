//! Comparable results, and the race between contenders.

use crate::measure::{Times, in_turn};
use crate::table::Row;

/// A result of one query. A query for the first hit or the nearest object has at most one result,
/// other queries have any number.
#[derive(Clone, Copy, Debug)]
pub struct Answer {
    /// The index of the query.
    pub query: u32,
    /// The index of the object or, for rays against a mesh, of the triangle.
    pub id: u32,
    /// The time of the hit, or the distance; zero for queries without either.
    pub key: f32,
}

/// The results of a contender, in ascending order of the queries.
pub type Answers = Vec<Answer>;

/// A contender that runs all queries of a case.
pub struct Contender<'a> {
    name: &'static str,
    ask: Box<dyn FnMut(&mut Answers) + 'a>,
}

impl<'a> Contender<'a> {
    /// Returns the name in the table.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// Creates a contender that runs all queries in one call of `ask`.
    pub fn batch(name: &'static str, ask: impl FnMut(&mut Answers) + 'a) -> Self {
        Self { name, ask: Box::new(ask) }
    }

    /// Creates a contender for the best result of each query. `ask` returns the index of the
    /// object, and its time or distance; `None` if nothing is found.
    pub fn best<Q>(
        name: &'static str,
        queries: Vec<Q>,
        mut ask: impl FnMut(&Q) -> Option<(u32, f32)> + 'a,
    ) -> Self
    where
        Q: 'a,
    {
        Self::batch(name, move |answers| {
            for (query, asked) in (0..).zip(&queries) {
                if let Some((id, key)) = ask(asked) {
                    answers.push(Answer { query, id, key });
                }
            }
        })
    }

    /// Creates a contender for all results of each query. `ask` calls back with the index of each
    /// object found.
    pub fn all<Q>(
        name: &'static str,
        queries: Vec<Q>,
        mut ask: impl FnMut(&Q, &mut dyn FnMut(u32)) + 'a,
    ) -> Self
    where
        Q: 'a,
    {
        Self::batch(name, move |answers| {
            for (query, asked) in (0..).zip(&queries) {
                ask(asked, &mut |id| answers.push(Answer { query, id, key: 0.0 }));
            }
        })
    }
}

/// The rule for comparing results of one case.
#[derive(Clone, Copy, Debug)]
pub enum Rule {
    /// At most one result per query. The keys must agree within this tolerance times the key of the
    /// first contender, or times 1 if that key is less. Another object with an equal key is
    /// accepted.
    Best(f32),
    /// Sets of objects, which must be equal. The results of a query are in ascending order of
    /// objects.
    All,
}

/// Runs each contender once and compares its results with those of the first contender. Then times
/// all contenders in turn, in nanoseconds per query.
pub fn race(
    case: &str,
    rule: Rule,
    count: usize,
    rounds: usize,
    lanes: Vec<Contender>,
) -> Vec<Row> {
    let (names, mut asks): (Vec<_>, Vec<_>) =
        lanes.into_iter().map(|lane| (lane.name, lane.ask)).unzip();
    let found: Vec<_> = asks.iter_mut().map(|ask| collected(ask)).collect();
    let times = timed_in_turn(rounds, count, &mut asks);
    let rows = names.iter().zip(times).zip(&found).map(|((name, times), answers)| Row {
        case: case.to_owned(),
        contender: (*name).to_owned(),
        answers: answers.len(),
        differ: differing(rule, &found[0], answers),
        times,
    });
    rows.collect()
}

fn collected(ask: &mut impl FnMut(&mut Answers)) -> Answers {
    let mut answers = Answers::new();
    ask(&mut answers);
    answers.sort_unstable_by_key(|answer| (answer.query, answer.id));
    answers
}

fn timed_in_turn(
    rounds: usize,
    count: usize,
    asks: &mut [Box<dyn FnMut(&mut Answers) + '_>],
) -> Vec<Times> {
    // All contenders write to the same vector of results, so that none pays for its growth.
    let answers = std::cell::RefCell::new(Answers::new());
    let mut runs: Vec<_> = asks
        .iter_mut()
        .map(|ask| {
            || {
                let mut answers = answers.borrow_mut();
                answers.clear();
                ask(&mut answers);
                std::hint::black_box(&*answers);
            }
        })
        .collect();
    let mut runs: Vec<&mut dyn FnMut()> = runs.iter_mut().map(|run| run as _).collect();
    in_turn(rounds, count, &mut runs)
}

/// Returns the number of differing results of two contenders.
fn differing(rule: Rule, first: &[Answer], other: &[Answer]) -> usize {
    let (mut left, mut right, mut agreed) = (0, 0, 0);
    while left < first.len() && right < other.len() {
        let (a, b) = (first[left], other[right]);
        let (at, bt) = match rule {
            Rule::Best(_) => ((a.query, 0), (b.query, 0)),
            Rule::All => ((a.query, a.id), (b.query, b.id)),
        };
        agreed += usize::from(at == bt && agree(rule, a, b));
        left += usize::from(at <= bt);
        right += usize::from(bt <= at);
    }
    // If both contenders have a result with different values, it counts once, not twice.
    match rule {
        Rule::Best(_) => first.len().max(other.len()) - agreed,
        Rule::All => first.len() + other.len() - 2 * agreed,
    }
}

fn agree(rule: Rule, a: Answer, b: Answer) -> bool {
    match rule {
        Rule::Best(tolerance) => (a.key - b.key).abs() <= tolerance * a.key.max(1.0),
        Rule::All => true,
    }
}

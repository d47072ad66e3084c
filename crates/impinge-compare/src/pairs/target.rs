//! The target times of impinge, and the comparison with them.

use std::collections::BTreeMap;

use super::question::Question;
use super::regime::PAIRS;
use crate::measure::Times;
use crate::table::Row;

/// The time of parry's manifold of two balls on the machine of the targets, in nanoseconds.
const PARRY_THERE: f64 = 41.0;

/// The part of an update in the narrow phase; the rivals have no such part.
pub const PART: &str = "impinge narrow phase";

/// This part, where pairs that have hardly moved keep their contacts.
pub const REUSING_PART: &str = "impinge reusing narrow phase";

/// Generators of pairs alone, and single queries.
pub const ALONE: &str = "impinge";

/// Generators of single pairs that keep contacts in this way.
pub const ALONE_REUSING: &str = "impinge alone reusing";

/// The beginning of a case, a question, and the target in nanoseconds per pair of the update of a world.
const TARGETS: &[(&str, Question, f64)] = &[
    ("3D ball, ball,", Question::ManifoldWarm, 8.0),
    ("3D ball, cuboid,", Question::ManifoldWarm, 8.0),
    ("3D capsule, capsule,", Question::ManifoldWarm, 15.0),
    ("3D cuboid, cuboid,", Question::ManifoldCold, 60.0),
    ("3D cuboid, cuboid,", Question::ManifoldUndisturbed, 15.0),
    ("2D cuboid, cuboid,", Question::ManifoldWarm, 10.0),
    ("3D 12-hull, 12-hull,", Question::ManifoldCold, 550.0),
    ("3D 12-hull, 12-hull,", Question::ManifoldWarm, 120.0),
    ("3D cylinder, cylinder,", Question::ManifoldCold, 1300.0),
    ("3D cylinder, cylinder,", Question::ManifoldWarm, 250.0),
    ("3D ball, mesh,", Question::ManifoldWarm, 300.0),
    ("3D cuboid, mesh,", Question::ManifoldWarm, 1000.0),
];

/// The overall results of the suite.
#[derive(Debug, Default)]
pub struct Verdicts {
    /// By question, and once more for kept contacts: the speed relative to the best rival.
    speeds: BTreeMap<String, Vec<f64>>,
    /// Cases where impinge took more than half of the time of its best rival: the ratio, the two times, and
    /// the rival.
    slower: Vec<(f64, [f64; 2], Row)>,
    cases: usize,
}

/// Returns the row of a target, if there is one for the case; `scale` is how much slower this machine is.
pub fn target(case: &str, question: Question, scale: f64) -> Option<Row> {
    let is_meant =
        |(start, of, _): &&(&str, Question, f64)| case.starts_with(start) && *of == question;
    let (_, _, most) = TARGETS.iter().find(is_meant)?;
    let mut times = Times::default();
    times.push(most * scale);
    let contender = "target".to_owned();
    Some(Row { case: case.to_owned(), contender, answers: 0, differ: 0, times })
}

/// Returns how much slower this machine is than that of the targets, by the time of parry's manifold of two
/// balls here.
pub fn machine_scale(parry: f64) -> f64 {
    parry / PARRY_THERE
}

fn is_ours(row: &Row) -> bool {
    row.contender.starts_with("impinge")
}

/// Whether the row belongs to a rival, whose results agree with ours for at least half of the pairs:
/// finding nothing is fast.
fn is_rival(row: &&Row) -> bool {
    !is_ours(row) && row.contender != "target" && 2 * row.differ <= PAIRS
}

fn least<'a>(rows: impl Iterator<Item = &'a Row>) -> Option<&'a Row> {
    rows.min_by(|a, b| a.times.median().total_cmp(&b.times.median()))
}

impl Verdicts {
    /// Adds the rows of one case. Manifolds of a world are compared with rivals by the time of its narrow
    /// phase.
    pub fn add(&mut self, question: Question, rows: &[Row]) {
        let Some(rival) = least(rows.iter().filter(is_rival)) else { return };
        let named = |name: &str| rows.iter().find(|row| row.contender == name);
        let best = || least(rows.iter().filter(|row| is_ours(row)));
        let ours = if question.is_manifold() { named(PART) } else { best() };
        let Some(ours) = ours else { return };
        self.cases += 1;
        let times = [ours, rival].map(|row| row.times.median());
        if times[0] > 0.5 * times[1] {
            self.slower.push((times[0] / times[1], times, rival.clone()));
        }
        let mut note = |name: String, time| {
            self.speeds.entry(name).or_default().push(times[1] / time);
        };
        note(question.name().to_owned(), times[0]);
        let others =
            [(REUSING_PART, "contacts kept"), (ALONE, "alone"), (ALONE_REUSING, "alone, kept")];
        for (name, what) in others.into_iter().filter(|_| question.is_manifold()) {
            if let Some(row) = named(name) {
                note(format!("{}, {what}", question.name()), row.times.median());
            }
        }
    }

    /// Prints the results by question, and the cases where impinge is not twice as fast as its best rival,
    /// worst first.
    pub fn print(&mut self) {
        println!("\ntimes as fast as the best rival, over all cases of a question");
        println!("{:<32} cases  median   >= 1   >= 2   >= 4", "question");
        for (question, speeds) in &mut self.speeds {
            speeds.sort_by(f64::total_cmp);
            let share = |least: f64| {
                let count = speeds.iter().filter(|speed| **speed >= least).count();
                100.0 * count as f64 / speeds.len() as f64
            };
            let (cases, median) = (speeds.len(), speeds[speeds.len() / 2]);
            let [one, two, four] = [1.0, 2.0, 4.0].map(share);
            println!(
                "{question:<32} {cases:>5} {median:>7.2} {one:>5.0}% {two:>5.0}% {four:>5.0}%"
            );
        }
        self.slower.sort_by(|a, b| b.0.total_cmp(&a.0));
        let (count, cases) = (self.slower.len(), self.cases);
        println!("\nmore than half of the time of the best rival: {count} of {cases} cases");
        println!("{:<56} {:>9} {:>9} {:>7}  rival", "case", "impinge", "rival", "ratio");
        for (ratio, [ours, theirs], rival) in &self.slower {
            let Row { case, contender, .. } = rival;
            println!("{case:<56} {ours:>9.1} {theirs:>9.1} {ratio:>7.2}  {contender}");
        }
    }
}

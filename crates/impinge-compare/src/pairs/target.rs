//! The target times of impinge, and the comparison of its times with those of the rivals.

use std::collections::BTreeMap;

use super::question::Question;
use super::regime::PAIRS;
use crate::measure::Times;
use crate::table::Row;

/// The time of parry's manifold of two balls on the machine for which the targets were set, in
/// nanoseconds.
const PARRY_THERE: f64 = 41.0;

/// The name of the row for the narrow phase of a world of impinge; the rivals have no such part.
pub const PART: &str = "impinge narrow phase";

/// The name of the row for the narrow phase of a world in which pairs keep their contacts.
pub const REUSING_PART: &str = "impinge reusing narrow phase";

/// The name of the contender with single calls.
pub const ALONE: &str = "impinge";

/// The name of the contender with single calls in which pairs keep their contacts.
pub const ALONE_REUSING: &str = "impinge alone reusing";

/// The targets: the beginning of the name of a case, the query, and the time in nanoseconds per
/// pair for the update of a world.
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

/// The comparison with the rivals over all cases of the suite.
#[derive(Debug, Default)]
pub struct Verdicts {
    /// The speeds of impinge relative to its rivals: the time of the best rival divided by that of
    /// impinge, for each case. The key is the name of the query, for a variant of impinge with the
    /// name of the variant.
    speeds: BTreeMap<String, Vec<f64>>,
    /// The cases in which impinge took more than half of the time of its best rival: the ratio,
    /// both times, and the row of the rival.
    slower: Vec<(f64, [f64; 2], Row)>,
    cases: usize,
}

/// Returns the row with the target of a case; `None` if it has none. `scale` is the factor of
/// [`machine_scale`].
pub fn target(case: &str, question: Question, scale: f64) -> Option<Row> {
    let is_meant =
        |(start, of, _): &&(&str, Question, f64)| case.starts_with(start) && *of == question;
    let (_, _, most) = TARGETS.iter().find(is_meant)?;
    let mut times = Times::default();
    times.push(most * scale);
    let contender = "target".to_owned();
    Some(Row { case: case.to_owned(), contender, answers: 0, differ: 0, times })
}

/// Returns the factor by which this machine is slower than that of the targets, from the time of
/// parry's manifold of two balls on this machine.
pub fn machine_scale(parry: f64) -> f64 {
    parry / PARRY_THERE
}

fn is_ours(row: &Row) -> bool {
    row.contender.starts_with("impinge")
}

/// Returns `true` if the row belongs to another library whose results differ from ours for at most
/// half of the pairs. Without this bound, a contender that finds nothing would count as a fast
/// rival.
fn is_rival(row: &&Row) -> bool {
    !is_ours(row) && row.contender != "target" && 2 * row.differ <= PAIRS
}

fn least<'a>(rows: impl Iterator<Item = &'a Row>) -> Option<&'a Row> {
    rows.min_by(|a, b| a.times.median().total_cmp(&b.times.median()))
}

impl Verdicts {
    /// Adds the rows of one case. For manifolds the time of impinge is that of the narrow phase of
    /// a world, for other queries its best time.
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

    /// Prints the speeds by query, and the cases in which impinge is not twice as fast as its best
    /// rival, beginning with the worst.
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

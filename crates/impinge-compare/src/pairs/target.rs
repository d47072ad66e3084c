//! The times that impinge is to reach, and whether it does.

use super::question::Question;
use crate::measure::Times;
use crate::table::Row;

/// The manifold of two balls takes parry so many nanoseconds on the machine that targets are for.
const PARRY_THERE: f64 = 41.0;

/// What the narrow phase takes of an update; its rivals have no such part.
pub const PART: &str = "impinge narrow phase";

/// The same where pairs that have hardly moved keep their contacts.
pub const REUSING_PART: &str = "impinge reusing narrow phase";

/// A case by its beginning, a question, and the most nanoseconds per pair of the world's update.
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

/// How the suite went.
#[derive(Debug, Default)]
pub struct Verdicts {
    /// Cases where impinge took more than half of the time of its best rival: how much more, the two
    /// times, and the rival.
    slower: Vec<(f64, [f64; 2], Row)>,
    cases: usize,
}

/// The row of a target, if there is one for the case; `scale` is how much slower this machine is.
pub fn target(case: &str, question: Question, scale: f64) -> Option<Row> {
    let is_meant =
        |(start, of, _): &&(&str, Question, f64)| case.starts_with(start) && *of == question;
    let (_, _, most) = TARGETS.iter().find(is_meant)?;
    let mut times = Times::default();
    times.push(most * scale);
    let contender = "target".to_owned();
    Some(Row { case: case.to_owned(), contender, answers: 0, differ: 0, times })
}

/// How much slower this machine is than that of the targets, by what the manifold of two balls takes
/// parry here.
pub fn machine_scale(parry: f64) -> f64 {
    parry / PARRY_THERE
}

fn is_ours(row: &Row) -> bool {
    row.contender.starts_with("impinge")
}

fn least<'a>(rows: impl Iterator<Item = &'a Row>) -> Option<&'a Row> {
    rows.min_by(|a, b| a.times.median().total_cmp(&b.times.median()))
}

impl Verdicts {
    /// Looks at the rows of one case.
    pub fn add(&mut self, rows: &[Row]) {
        let is_whole =
            |row: &&Row| is_ours(row) && ![PART, REUSING_PART].contains(&&*row.contender);
        let ours = least(rows.iter().filter(is_whole));
        let is_rival = |row: &&Row| !is_ours(row) && row.contender != "target";
        let rival = least(rows.iter().filter(is_rival));
        let (Some(ours), Some(rival)) = (ours, rival) else { return };
        self.cases += 1;
        let times = [ours, rival].map(|row| row.times.median());
        let ratio = times[0] / times[1];
        if ratio > 0.5 {
            self.slower.push((ratio, times, rival.clone()));
        }
    }

    /// Prints the cases where impinge is not twice as fast as its best rival, worst first.
    pub fn print(&mut self) {
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

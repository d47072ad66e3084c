//! Tables of results: printed for readers, and written as CSV files below `bench/`.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::measure::Times;

/// The results of one contender in one case of a suite.
#[derive(Clone, Debug)]
pub struct Row {
    /// The case, such as `boxes, 10000, 1 % moving`; equal for all contenders.
    pub case: String,
    /// The name of the contender.
    pub contender: String,
    /// The number of results, such as pairs, hits or contact points.
    pub answers: usize,
    /// The number of results that differ from those of the first contender of the case.
    pub differ: usize,
    /// The time of each run.
    pub times: Times,
}

/// The rows of one suite.
#[derive(Clone, Debug)]
pub struct Table {
    suite: &'static str,
    unit: &'static str,
    rows: Vec<Row>,
}

impl Table {
    /// Creates an empty table and prints its head. `unit` is the unit of all times.
    pub fn new(suite: &'static str, unit: &'static str) -> Self {
        println!("\n{suite}, {unit}; the ratio is to impinge");
        println!(
            "{:<56} {:<18} {:>9} {:>7} {:>11} {:>11} {:>11} {:>7}",
            "case", "contender", "answers", "differ", "median", "minimum", "p90", "ratio"
        );
        Self { suite, unit, rows: Vec::new() }
    }

    /// Adds and prints rows; the ratio of a row is relative to the first row of its case.
    pub fn add(&mut self, rows: Vec<Row>) {
        for row in &rows {
            let first = rows.iter().find(|first| first.case == row.case);
            let base = first.map_or(f64::NAN, |first| first.times.median());
            let [median, minimum, p90] = [50, 0, 90].map(|percent| row.times.quantile(percent));
            println!(
                "{:<56} {:<18} {:>9} {:>7} {median:>11.4} {minimum:>11.4} {p90:>11.4} {:>7.2}",
                row.case,
                row.contender,
                row.answers,
                row.differ,
                median / base
            );
        }
        self.rows.extend(rows);
    }

    /// Writes the rows to `bench/<machine>/<suite>.csv`.
    pub fn write(&self, machine: &str) -> io::Result<PathBuf> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../bench").join(machine);
        fs::create_dir_all(&folder)?;
        let path = folder.join(format!("{}.csv", self.suite));
        let mut text =
            format!("case,contender,answers,differ,median_{0},minimum_{0},p90_{0}\n", self.unit);
        for row in &self.rows {
            let times = [50, 0, 90].map(|percent| format!("{:.5}", row.times.quantile(percent)));
            let Row { case, contender, answers, differ, .. } = row;
            text += &format!("\"{case}\",{contender},{answers},{differ},{}\n", times.join(","));
        }
        fs::write(&path, text)?;
        Ok(path)
    }
}

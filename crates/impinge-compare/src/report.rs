//! The table, on the screen and as a file.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

use impinge_scenes::Scene;

use crate::Arguments;
use crate::contender::{Lane, Race};

/// One contender in one scene; times in milliseconds per step.
#[derive(Clone, Debug)]
pub struct Row {
    scene: &'static str,
    dimension: usize,
    objects: usize,
    contender: &'static str,
    touching: usize,
    points: usize,
    disagreements: usize,
    first: f64,
    median: f64,
    minimum: f64,
    p90: f64,
    /// The median of the part spent on reading.
    reading: f64,
    /// The median over that of the first contender.
    ratio: f64,
}

impl Row {
    /// The rows of a race.
    pub fn of<const D: usize>(scene: &Scene<D>, race: &Race) -> Vec<Self> {
        let base = quantile(&race.lanes[0].times, 50);
        let row = |lane: &Lane| Self {
            scene: scene.name,
            dimension: D,
            objects: scene.objects.len(),
            contender: lane.name,
            touching: lane.touching,
            points: lane.reading.points,
            disagreements: race.disagreements,
            first: milliseconds(lane.first),
            median: quantile(&lane.times, 50),
            minimum: quantile(&lane.times, 0),
            p90: quantile(&lane.times, 90),
            reading: quantile(&lane.reading_times, 50),
            ratio: quantile(&lane.times, 50) / base,
        };
        race.lanes.iter().map(row).collect()
    }
}

fn milliseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}

/// The time that a percentage of the steps do not exceed; NaN for no steps.
fn quantile(times: &[Duration], percent: usize) -> f64 {
    let mut times = times.to_vec();
    times.sort_unstable();
    let last = times.len().saturating_sub(1);
    times.get(last * percent / 100).map_or(f64::NAN, |&time| milliseconds(time))
}

/// The head of the table.
pub fn print_header(arguments: &Arguments) {
    println!("{} objects, {} steps, milliseconds per step", arguments.objects, arguments.steps);
    println!(
        "{:<14} {:<2} {:<10} {:>9} {:>9} {:>7} {:>9} {:>9} {:>9} {:>9} {:>9} {:>6}",
        "scene",
        "D",
        "contender",
        "touching",
        "points",
        "differ",
        "first",
        "median",
        "minimum",
        "p90",
        "reading",
        "ratio"
    );
}

/// Some rows of the table: first by how many pairs the contenders differ, then the times.
pub fn print_rows(rows: &[Row]) {
    for row in rows {
        println!(
            "{:<14} {:<2} {:<10} {:>9} {:>9} {:>7} {:>9.3} {:>9.3} {:>9.3} {:>9.3} {:>9.3} {:>6.2}",
            row.scene,
            row.dimension,
            row.contender,
            row.touching,
            row.points,
            row.disagreements,
            row.first,
            row.median,
            row.minimum,
            row.p90,
            row.reading,
            row.ratio
        );
    }
}

/// Writes the table below `bench/` of the repository.
pub fn write_csv(machine: &str, rows: &[Row]) -> io::Result<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../bench").join(machine);
    fs::create_dir_all(&folder)?;
    let mut text = String::from(
        "scene,dimension,objects,contender,touching,points,disagreements,\
         first_ms,median_ms,minimum_ms,p90_ms,reading_ms,ratio\n",
    );
    for row in rows {
        let numbers = [row.first, row.median, row.minimum, row.p90, row.reading, row.ratio];
        let numbers = numbers.map(|x| format!("{x:.4}")).join(",");
        text += &format!(
            "{},{},{},{},{},{},{},{numbers}\n",
            row.scene,
            row.dimension,
            row.objects,
            row.contender,
            row.touching,
            row.points,
            row.disagreements
        );
    }
    let path = folder.join("compare.csv");
    fs::write(&path, text)?;
    Ok(path)
}

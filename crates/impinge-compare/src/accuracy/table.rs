//! Writes the tables: a line of a CSV file for every row and contender, and a line of `accuracy.md`
//! for every pair of kinds with one dimension and scalar.

use std::fmt::Write;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::judge::{Errors, extremes};
use super::sample::Regime;
use super::{CONTENDERS, Row};

/// Prints one row on the screen.
pub fn print(row: &Row) {
    let worst = |errors: &Errors| {
        let [p999, most] = extremes(&errors.units).unwrap_or([f64::NAN; 2]);
        let angle = extremes(&errors.angle).map_or(f64::NAN, |angle| angle[0]);
        let odd = errors.missing + errors.wrong_sign;
        format!("{p999:>9.2e} {most:>9.2e} {angle:>9.2e} {odd:>5}")
    };
    println!(
        "{}D {} {:<10} {:<10} {:<8} {:>5} -{:<4} | {} | {}",
        row.dimension,
        row.scalar.name(),
        row.kinds[0].name(),
        row.kinds[1].name(),
        row.regime.name(),
        row.errors[0].asked,
        row.dropped,
        worst(&row.errors[0]),
        worst(&row.errors[1]),
    );
}

/// Writes `accuracy.md` and the files of `accuracy/` below `bench/` of the repository.
pub fn write(rows: &[Row], samples: usize) -> io::Result<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../bench");
    fs::create_dir_all(folder.join("accuracy"))?;
    for part in parts(rows) {
        let name = format!("{}d-{}.csv", part[0].dimension, part[0].scalar.name());
        fs::write(folder.join("accuracy").join(name), csv(part))?;
    }
    fs::write(folder.join("accuracy.md"), page(rows, samples))?;
    Ok(folder)
}

/// Returns the rows grouped by dimension and scalar.
fn parts(rows: &[Row]) -> impl Iterator<Item = &[Row]> {
    rows.chunk_by(|a, b| a.dimension == b.dimension && a.scalar == b.scalar)
}

const HEAD: &str = "dimension,scalar,first,second,regime,contender,samples,dropped,unsupported,\
    missing,wrong_sign,units_p999,units_max,relative_p999,relative_max,angle_p999,angle_max,ties,\
    loss_p999,loss_max\n";

fn csv(rows: &[Row]) -> String {
    let mut text = HEAD.to_owned();
    for row in rows {
        for (name, errors) in CONTENDERS.iter().zip(&row.errors) {
            let numbers = |list: &[f64]| {
                extremes(list).map_or(",".to_owned(), |[p, most]| format!("{p:.3e},{most:.3e}"))
            };
            let counts =
                [errors.asked, row.dropped, errors.unsupported, errors.missing, errors.wrong_sign];
            let counts = counts.map(|count| count.to_string()).join(",");
            writeln!(
                text,
                "{},{},{},{},{},{name},{counts},{},{},{},{},{}",
                row.dimension,
                row.scalar.name(),
                row.kinds[0].name(),
                row.kinds[1].name(),
                row.regime.name(),
                numbers(&errors.units),
                numbers(&errors.relative),
                numbers(&errors.angle),
                errors.ties,
                numbers(&errors.loss),
            )
            .expect("a string takes all");
        }
    }
    text
}

fn page(rows: &[Row], samples: usize) -> String {
    let mut text = include_str!("page.md").replace("{samples}", &samples.to_string());
    for part in parts(rows) {
        let (dimension, scalar) = (part[0].dimension, part[0].scalar.name());
        let place = if dimension == 2 { "The plane" } else { "Space" };
        write!(text, "\n## {place}, `{scalar}`\n\n").expect("a string takes all");
        text += "| pair | distance | | depth | | normal | | remarks |\n";
        text += "|---|---|---|---|---|---|---|---|\n";
        text += "| | impinge | parry | impinge | parry | impinge | parry | |\n";
        for pair in part.chunk_by(|a, b| a.kinds == b.kinds) {
            text += &line(pair);
        }
    }
    text
}

/// Returns the line of a pair, which summarizes all its regimes.
fn line(rows: &[Row]) -> String {
    let together = |contender: usize, keep: &dyn Fn(&Row) -> bool| {
        let mut all = Errors::default();
        rows.iter().filter(|row| keep(row)).for_each(|row| all.extend(&row.errors[contender]));
        all
    };
    let both = |keep: &dyn Fn(&Row) -> bool| [0, 1].map(|contender| together(contender, keep));
    let distance = both(&|row| !row.regime.is_overlap()).map(|errors| cell(&errors.units));
    let depth = both(&|row| row.regime.is_overlap()).map(|errors| cell(&errors.units));
    let normal = both(&|row| row.regime != Regime::Touching).map(|errors| cell(&errors.angle));
    let all = both(&|_| true);
    let mut remarks: Vec<String> = [0, 1].into_iter().flat_map(|n| remarks(n, &all[n])).collect();
    let dropped: usize = rows.iter().map(|row| row.dropped).sum();
    if dropped > 0 {
        remarks.push(format!("{dropped} left out"));
    }
    format!(
        "| {} – {} | {} | {} | {} | {} | {} | {} | {} |\n",
        rows[0].kinds[0].name(),
        rows[0].kinds[1].name(),
        distance[0],
        distance[1],
        depth[0],
        depth[1],
        normal[0],
        normal[1],
        remarks.join("; ")
    )
}

/// Formats the 99.9th percentile and the largest of some errors; a dash without errors.
fn cell(errors: &[f64]) -> String {
    extremes(errors).map_or("–".to_owned(), |[p, most]| format!("{} / {}", short(p), short(most)))
}

/// Formats a number with about two significant digits.
fn short(x: f64) -> String {
    match x {
        _ if x == 0.0 => "0".to_owned(),
        _ if x.is_infinite() => "∞".to_owned(),
        0.01..10.0 => format!("{x:.2}"),
        10.0..10_000.0 => format!("{x:.0}"),
        _ => format!("{x:.0e}"),
    }
}

fn remarks(contender: usize, errors: &Errors) -> Vec<String> {
    let name = CONTENDERS[contender];
    if errors.asked > 0 && errors.unsupported == errors.asked {
        return vec![format!("{name}: unsupported")];
    }
    let counts = [(errors.missing, "no contact"), (errors.wrong_sign, "wrong sign")];
    let told = counts.into_iter().filter(|(count, _)| *count > 0);
    told.map(|(count, what)| format!("{name}: {count} {what}")).collect()
}

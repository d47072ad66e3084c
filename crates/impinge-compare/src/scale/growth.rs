//! Writes the times by number of boxes: as lines of numbers, and as a drawing with logarithmic
//! axes.

use std::collections::BTreeMap;
use std::error::Error;
use std::fs;
use std::path::Path;

use plotters::prelude::*;

/// The size of the drawing in pixels. The charts of all subjects share its width.
const SIZE: (u32, u32) = (1200, 520);

/// The times of one contender for one number of boxes, in milliseconds.
#[derive(Clone, Debug)]
pub struct Measured {
    pub subject: String,
    pub contender: String,
    pub boxes: usize,
    pub median: f64,
    pub minimum: f64,
}

/// Writes `scale-series.csv`, one measurement per line, and `scale.svg` into the folder.
pub fn write(measured: &[Measured], folder: &Path) -> Result<(), Box<dyn Error>> {
    fs::create_dir_all(folder)?;
    fs::write(folder.join("scale-series.csv"), lines(measured))?;
    draw(measured, &folder.join("scale.svg"))
}

fn lines(measured: &[Measured]) -> String {
    let mut lines = "subject,contender,boxes,median_ms,minimum_ms\n".to_owned();
    for Measured { subject, contender, boxes, median, minimum } in measured {
        lines += &format!("{subject},{contender},{boxes},{median:.5},{minimum:.5}\n");
    }
    lines
}

/// The number of boxes and the median time of each measurement, by contender.
type Curves<'a> = BTreeMap<&'a str, Vec<(f64, f64)>>;

/// Draws one chart for each subject, side by side.
fn draw(measured: &[Measured], path: &Path) -> Result<(), Box<dyn Error>> {
    let mut subjects: BTreeMap<&str, Curves<'_>> = BTreeMap::new();
    for one in measured {
        let curves = subjects.entry(&one.subject).or_default();
        curves.entry(&one.contender).or_default().push((one.boxes as f64, one.median));
    }
    let sheet = SVGBackend::new(path, SIZE).into_drawing_area();
    sheet.fill(&WHITE)?;
    for ((subject, curves), area) in subjects.iter().zip(sheet.split_evenly((1, subjects.len()))) {
        chart(subject, curves, &area)?;
    }
    sheet.present()?;
    Ok(())
}

/// Draws the curves of one subject; both axes cover all of its measurements.
fn chart<B: DrawingBackend>(
    subject: &str,
    curves: &Curves<'_>,
    area: &DrawingArea<B, plotters::coord::Shift>,
) -> Result<(), Box<dyn Error>>
where
    B::ErrorType: 'static,
{
    let reach = |of: fn(&(f64, f64)) -> f64| {
        let all = || curves.values().flatten().map(of);
        all().fold(f64::INFINITY, f64::min)..all().fold(0.0, f64::max)
    };
    let axes = (reach(|at| at.0).log_scale(), reach(|at| at.1).log_scale());
    let mut chart = ChartBuilder::on(area)
        .caption(format!("{subject}: one step, all boxes moving"), ("sans-serif", 18))
        .margin(12)
        .margin_right(40)
        .x_label_area_size(40)
        .y_label_area_size(64)
        .build_cartesian_2d(axes.0, axes.1)?;
    let mut mesh = chart.configure_mesh();
    mesh.x_desc("boxes").x_label_formatter(&f64::to_string);
    mesh.y_desc("milliseconds").y_label_formatter(&f64::to_string).draw()?;
    for (contender, curve) in curves {
        let colour = colour(contender);
        let line = LineSeries::new(curve.iter().copied(), colour.stroke_width(2)).point_size(3);
        let key = move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour.stroke_width(2));
        chart.draw_series(line)?.label(*contender).legend(key);
    }
    let mut names = chart.configure_series_labels();
    names.position(SeriesLabelPosition::UpperLeft).background_style(WHITE).border_style(BLACK);
    names.draw()?;
    Ok(())
}

/// Returns the colour of a contender, the same in all charts.
fn colour(contender: &str) -> RGBColor {
    match contender {
        "impinge" => RGBColor(200, 30, 40),
        "rapier" => RGBColor(30, 90, 190),
        "ncollide" => RGBColor(110, 110, 110),
        _ => RGBColor(40, 140, 70),
    }
}

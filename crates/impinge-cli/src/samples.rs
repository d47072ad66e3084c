//! `impinge samples`: the samples as a list, or as a folder for browsers.

use core::fmt::Write as _;
use std::fs;
use std::path::Path;

use impinge::debug_render::{DebugDrawing, DebugOptions};
use impinge::dim3::math::Vector;
use impinge::math::Real;
use impinge_samples::{Entry, Make, Running, Sample, entries};
use impinge_view::{Camera, PngPicture};
use serde::Serialize;

use crate::args::{SamplesArgs, Size};
use crate::error::CliError;
use crate::extent::extent;
use crate::output::{self, FAINT, NAME, Outcome, Report, finish};
use crate::page::assets;
use crate::progress::Progress;
use crate::render::object_color;
use crate::space::Stage;

/// Runs the verb.
pub(crate) fn run(args: &SamplesArgs) -> Result<Outcome, CliError> {
    if let Some(folder) = &args.output {
        impinge_html::gallery(&assets(&args.page)?, folder)?;
        thumbnails(folder, args.size)?;
    }
    let output = args.output.as_ref().map(|folder| folder.display().to_string());
    let samples = entries().iter().map(Listed::of).collect();
    finish(&SamplesReport { output, samples }, args.format)
}

/// The samples there are.
#[derive(Debug, Serialize)]
struct SamplesReport {
    output: Option<String>,
    samples: Vec<Listed>,
}

/// A sample of the list.
#[derive(Debug, Serialize)]
struct Listed {
    name: &'static str,
    title: &'static str,
    about: &'static str,
    dimension: usize,
}

impl Listed {
    const fn of(entry: &Entry) -> Self {
        let dimension = entry.make.dimension();
        Self { name: entry.name, title: entry.title, about: entry.about, dimension }
    }
}

impl Report for SamplesReport {
    fn text(&self) -> String {
        let mut text = String::new();
        if let Some(output) = &self.output {
            let count = self.samples.len();
            let _ = writeln!(text, "{NAME}{output}{NAME:#}: {count} samples");
            return text;
        }
        for Listed { name, title, about, .. } in &self.samples {
            let _ = writeln!(text, "{NAME}{name}{NAME:#}  {title}\n  {FAINT}{about}{FAINT:#}");
        }
        text
    }

    fn outcome(&self) -> Outcome {
        Outcome::Clear
    }
}

/// What a picture shows comes after so many steps.
const STEPS: usize = 45;

/// Writes a small picture of each sample.
fn thumbnails(folder: &Path, size: Size) -> Result<(), CliError> {
    let folder = folder.join("thumbnails");
    fs::create_dir_all(&folder).map_err(|error| CliError::Write { path: folder.clone(), error })?;
    let mut progress = Progress::new(entries().len(), "drawing samples");
    for entry in entries() {
        let spatial = Camera::look_along(&Vector::new(-1.0, -1.0, -2.0), &Vector::y());
        let picture = match entry.make {
            Make::Plane(make) => thumbnail(entry, make(), PngPicture::new(Camera::plane(), size.0)),
            Make::Space(make) => thumbnail(entry, make(), PngPicture::new(spatial, size.0)),
        };
        output::write(&folder.join(format!("{}.png", entry.name)), &picture?)?;
        progress.step();
    }
    Ok(())
}

/// A sample after some steps.
fn thumbnail<const D: usize>(
    entry: &Entry,
    sample: Box<dyn Sample<D>>,
    picture: PngPicture,
) -> Result<Vec<u8>, CliError>
where
    f32: Stage<D>,
{
    let failed = |error| CliError::Sample { name: entry.name, error };
    let mut running = Running::new(sample).map_err(failed)?;
    for _ in 0..STEPS {
        running.advance().map_err(failed)?;
    }
    let extent = extent(running.world());
    let mut options = DebugOptions::default();
    options.mesh.half_space_extent = f32::lit(extent.whole);
    let mut picture = picture.without_texts();
    let mut drawing = DebugDrawing::new(options).with_object_color(object_color);
    drawing.world(running.world(), &mut picture);
    running.draw(&mut drawing, &mut picture);
    Ok(picture.to_png())
}

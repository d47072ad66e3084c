//! `impinge samples`: lists the samples, or writes them to a folder for browsers.

use core::fmt;
use std::fs;
use std::path::Path;

use impinge::debug_render::DebugOptions;
use impinge::dim3::math::Vector;
use impinge_files::Printable;
use impinge_samples::{Entry, Make, Running, Sample, entries};
use impinge_view::{Camera, PngPicture, world_drawing};
use serde::Serialize;

use crate::args::{SamplesArgs, Size};
use crate::error::CliError;
use crate::output::{self, FAINT, NAME, Outcome, Report, finish};
use crate::page::assets;
use crate::progress::Progress;
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

/// The report of all samples.
#[derive(Debug, Serialize)]
struct SamplesReport {
    /// The folder that was written; `None` if the samples were only listed.
    output: Option<String>,
    samples: Vec<Listed>,
}

/// The fields of a sample in the report.
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

impl fmt::Display for SamplesReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(output) = &self.output {
            let output = Printable(output);
            return writeln!(f, "{NAME}{output}{NAME:#}: {} samples", self.samples.len());
        }
        for Listed { name, title, about, .. } in &self.samples {
            writeln!(f, "{NAME}{name}{NAME:#}  {title}\n  {FAINT}{about}{FAINT:#}")?;
        }
        Ok(())
    }
}

impl Report for SamplesReport {}

/// The number of steps before the thumbnail of a sample is drawn. Most samples have contacts by
/// then.
const STEPS: usize = 45;

/// The largest number of contact pairs for which a thumbnail shows contacts. More contacts would
/// hide the objects.
const MAX_PAIRS: usize = 1000;

/// Writes a thumbnail of each sample to the subfolder `thumbnails`.
fn thumbnails(folder: &Path, size: Size) -> Result<(), CliError> {
    let folder = folder.join("thumbnails");
    fs::create_dir_all(&folder).map_err(|error| CliError::Write { path: folder.clone(), error })?;
    let mut progress = Progress::new(entries().len(), "drawing samples");
    for entry in entries() {
        let picture = match entry.make {
            Make::Plane(make) => thumbnail(entry, make(), size),
            Make::Space(make) => thumbnail(entry, make(), size),
        };
        output::write(&folder.join(format!("{}.png", entry.name)), &picture?)?;
        progress.step();
    }
    Ok(())
}

/// Returns a picture of a sample after [`STEPS`] steps, as the bytes of a PNG file.
fn thumbnail<const D: usize>(
    entry: &Entry,
    sample: Box<dyn Sample<D>>,
    size: Size,
) -> Result<Vec<u8>, CliError>
where
    f32: Stage<D>,
{
    let failed = |error| CliError::Sample { name: entry.name, error };
    let mut running = Running::new(sample).map_err(failed)?;
    for _ in 0..STEPS {
        running.advance().map_err(failed)?;
    }
    let spatial = Camera::look_along(&Vector::new(-1.0, -1.0, -2.0), &Vector::y());
    let mut picture = PngPicture::new(<f32 as Stage<D>>::camera(spatial), size.0).without_texts();
    let mut options = DebugOptions::default();
    if running.world().contact_pairs().count() > MAX_PAIRS {
        (options.contact_point, options.contact_normal) = (None, None);
    }
    let mut drawing = world_drawing(running.world(), options);
    drawing.world(running.world(), &mut picture);
    running.draw(&mut drawing, &mut picture);
    Ok(picture.to_png())
}

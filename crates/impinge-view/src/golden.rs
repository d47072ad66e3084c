//! Compares images and texts with golden files.

use crate::compare::compare;
use crate::image::{Image, ImageError};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::{env, fmt, fs, io};

/// A folder of golden files, and a folder for the results of failed checks: the image and its
/// difference from the golden image, or the text.
///
/// With the environment variable `IMPINGE_BLESS=1` a check writes the golden file instead of
/// reading it.
///
/// ```
/// use impinge_view::{Golden, GoldenError, Image};
///
/// let failures = std::env::temp_dir().join("impinge-view-example");
/// let golden = Golden::new("no/such/folder").with_failures(failures).with_bless(false);
/// let found = golden.check("image", &Image::filled([1, 1], [0; 4]));
/// assert!(matches!(found, Err(GoldenError::Missing { .. })));
/// ```
#[derive(Clone, Debug)]
pub struct Golden {
    folder: PathBuf,
    failures: PathBuf,
    bless: bool,
    tolerance: u8,
    allowed: u64,
}

impl Golden {
    /// Uses the golden files in a folder. Results of failed checks are written to the folder
    /// `impinge-view` in `CARGO_TARGET_DIR`, or in the folder `target` of the workspace that
    /// contains the current folder.
    #[must_use]
    pub fn new(folder: impl Into<PathBuf>) -> Self {
        let bless = env::var_os("IMPINGE_BLESS").is_some_and(|value| value == "1");
        let failures = target_folder().join("impinge-view");
        Self { folder: folder.into(), failures, bless, tolerance: 0, allowed: 0 }
    }

    /// Sets the folder to which results of failed checks are written.
    #[must_use]
    pub fn with_failures(self, failures: impl Into<PathBuf>) -> Self {
        Self { failures: failures.into(), ..self }
    }

    /// Sets whether checks write the golden files instead of reading them, regardless of the
    /// environment.
    #[must_use]
    pub fn with_bless(self, bless: bool) -> Self {
        Self { bless, ..self }
    }

    /// Allows the channels of all pixels to differ by up to `tolerance`, and those of `allowed`
    /// pixels to differ by more. By default both are 0: the images must be equal.
    #[must_use]
    pub fn with_bound(self, tolerance: u8, allowed: u64) -> Self {
        Self { tolerance, allowed, ..self }
    }

    /// Compares an image with the golden image `NAME.png`.
    ///
    /// # Errors
    ///
    /// If there is no golden image or it is not a valid PNG, if the image differs by more than the
    /// bound, or if a file cannot be written. Unless the golden image is invalid, `NAME.png` and,
    /// after a comparison, `NAME.difference.png` are written to the folder of failures.
    pub fn check(&self, name: &str, image: &Image) -> Result<(), GoldenError> {
        let path = self.folder.join(format!("{name}.png"));
        if self.bless {
            return Ok(write(&path, &image.to_png())?);
        }
        let found = self.failures.join(format!("{name}.png"));
        let Ok(bytes) = fs::read(&path) else {
            write(&found, &image.to_png())?;
            return Err(GoldenError::Missing { golden: path, image: found });
        };
        let golden = Image::from_png(&bytes).map_err(GoldenError::Image)?;
        let difference = compare(image, &golden, self.tolerance);
        if difference.pixels <= self.allowed && image.size() == golden.size() {
            return Ok(());
        }
        write(&found, &image.to_png())?;
        let marked = self.failures.join(format!("{name}.difference.png"));
        write(&marked, &difference.picture.to_png())?;
        let (pixels, largest) = (difference.pixels, difference.largest);
        Err(GoldenError::Differs { pixels, largest, image: found })
    }

    /// Compares a text with the golden file of this name, for instance a picture `NAME.svg`. The
    /// texts must be equal; the bound of [`Self::with_bound`] applies to images only.
    ///
    /// # Errors
    ///
    /// If there is no golden text, or the text differs from it. The text is then written to the
    /// folder of failures.
    pub fn check_text(&self, name: &str, text: &str) -> Result<(), GoldenError> {
        let path = self.folder.join(name);
        if self.bless {
            return Ok(write(&path, text.as_bytes())?);
        }
        let golden = fs::read_to_string(&path);
        if golden.as_ref().is_ok_and(|golden| golden == text) {
            return Ok(());
        }
        let found = self.failures.join(name);
        write(&found, text.as_bytes())?;
        let Ok(golden) = golden else {
            return Err(GoldenError::Missing { golden: path, image: found });
        };
        let same = golden.lines().zip(text.lines()).take_while(|(golden, own)| golden == own);
        Err(GoldenError::TextDiffers { line: same.count() + 1, text: found })
    }
}

fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)?;
    }
    fs::write(path, bytes)
}

fn target_folder() -> PathBuf {
    if let Some(folder) = env::var_os("CARGO_TARGET_DIR") {
        return folder.into();
    }
    let current = env::current_dir().unwrap_or_default();
    let root = current.ancestors().find(|folder| folder.join("Cargo.lock").exists());
    root.unwrap_or(&current).join("target")
}

/// The reason why an image or text fails the comparison.
#[derive(Debug)]
#[non_exhaustive]
pub enum GoldenError {
    /// There is no golden file, or it cannot be read.
    Missing {
        /// The path of the golden file.
        golden: PathBuf,
        /// The path to which the checked image or text was written.
        image: PathBuf,
    },
    /// More pixels differ than allowed, or the sizes differ.
    Differs {
        /// The number of pixels that differ by more than the tolerance.
        pixels: u64,
        /// The largest difference of a channel.
        largest: u8,
        /// The path to which the checked image was written. The picture of the difference is in the
        /// same folder.
        image: PathBuf,
    },
    /// A text differs.
    TextDiffers {
        /// The first line that differs, counted from 1.
        line: usize,
        /// The path to which the checked text was written.
        text: PathBuf,
    },
    /// The golden image is not a valid PNG.
    Image(ImageError),
    /// A file could not be written.
    Io(io::Error),
}

impl From<io::Error> for GoldenError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl fmt::Display for GoldenError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing { golden, image } => {
                let (golden, image) = (golden.display(), image.display());
                write!(formatter, "no golden image {golden}; IMPINGE_BLESS=1 makes it of {image}")
            }
            Self::Differs { pixels, largest, image } => {
                let image = image.display();
                write!(formatter, "{image}: {pixels} pixels differ, by up to {largest} of 255")
            }
            Self::TextDiffers { line, text } => {
                write!(formatter, "{}: line {line} differs", text.display())
            }
            Self::Image(error) => error.fmt(formatter),
            Self::Io(error) => error.fmt(formatter),
        }
    }
}

impl Error for GoldenError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_compared_line_by_line() {
        let folder = env::temp_dir().join(format!("impinge-view-text-{}", std::process::id()));
        let golden = Golden::new(folder.join("golden")).with_failures(folder.join("failures"));
        let missing = golden.clone().with_bless(false).check_text("a.svg", "one\ntwo\n");
        assert!(matches!(missing, Err(GoldenError::Missing { .. })), "{missing:?}");
        golden.clone().with_bless(true).check_text("a.svg", "one\ntwo\n").expect("written");
        let golden = golden.with_bless(false);
        golden.check_text("a.svg", "one\ntwo\n").expect("the same");
        let error = golden.check_text("a.svg", "one\n2\n").expect_err("another line");
        assert!(matches!(error, GoldenError::TextDiffers { line: 2, .. }), "{error}");
        let left = fs::read_to_string(folder.join("failures/a.svg")).expect("left behind");
        assert_eq!(left, "one\n2\n");
        fs::remove_dir_all(folder).expect("can be removed");
    }

    #[test]
    fn failures_leave_the_image_and_the_difference() {
        let folder = env::temp_dir().join(format!("impinge-view-{}", std::process::id()));
        let golden = Golden::new(folder.join("golden")).with_failures(folder.join("failures"));
        let image = Image::filled([5, 4], [9, 9, 9, 255]);
        golden.clone().with_bless(true).check("plain", &image).expect("written");
        let golden = golden.with_bless(false);
        golden.check("plain", &image).expect("the same");
        let mut other = image.clone();
        other.set_pixel(0, 0, [19, 9, 9, 255]);
        let error = golden.check("plain", &other).expect_err("one pixel differs");
        assert!(matches!(error, GoldenError::Differs { pixels: 1, largest: 10, .. }), "{error}");
        golden.clone().with_bound(0, 1).check("plain", &other).expect("one pixel is allowed");
        golden.clone().with_bound(10, 0).check("plain", &other).expect("10 is tolerated");
        let larger = Image::filled([5, 5], [9, 9, 9, 255]);
        golden.clone().with_bound(255, 99).check("plain", &larger).expect_err("another size");
        let written = fs::read(folder.join("failures/plain.png")).expect("left behind");
        assert_eq!(Image::from_png(&written), Ok(larger), "the last failure");
        assert!(folder.join("failures/plain.difference.png").exists(), "left behind");
        fs::remove_dir_all(folder).expect("can be removed");
    }
}

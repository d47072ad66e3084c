//! Errors of reading files and scenes: the problem and its position in the file.

use core::fmt;
use std::io;
use std::path::PathBuf;

use impinge_record::{LibraryError, RecordError};

use crate::text::{self, Printable, Quoted};
use crate::{Dimension, Limit};

/// An error of reading a file or building its scene: the file, the position if known, and the
/// problem.
///
/// ```
/// use impinge_files::{Problem, Scene};
/// use impinge_record::LibraryError;
///
/// let text = r#"{"dimension": 2, "objects": [
///     {"name": "ball", "shape": {"ball": {"radius": -1}}}
/// ]}"#;
/// let scene = Scene::from_json("scene.json", text)?;
/// let error = scene.collision_world::<f64, 2>().expect_err("no radius");
/// assert_eq!((error.line, error.column), (Some(2), Some(51)));
/// assert_eq!(error.path, "objects[0].shape.ball.radius");
/// assert_eq!(error.value.as_deref(), Some("-1"));
/// assert!(matches!(*error.problem, Problem::Library(LibraryError::Shape(_))));
/// assert_eq!(
///     error.to_string(),
///     "scene.json:2:51: objects[0].shape.ball.radius: the radius is -1, below zero"
/// );
/// # Ok::<(), impinge_files::FileError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct FileError {
    /// The path of the file, as the caller named it.
    pub file: PathBuf,
    /// The line, counted from 1. `None` for binary formats and for scenes that were not parsed from
    /// a text, and if the parser reports no line.
    pub line: Option<usize>,
    /// The column in characters, counted from 1; `None` if only the line or neither is known.
    pub column: Option<usize>,
    /// The path in the document, such as `objects[3].shape.ball.radius`; empty for the whole file.
    pub path: String,
    /// The value at `path`, on one line and shortened; `None` if the message quotes no value.
    pub value: Option<String>,
    /// The problem; boxed, so that `Result`s stay small.
    pub problem: Box<Problem>,
}

/// The kind of a [`FileError`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Problem {
    /// The file cannot be read.
    Io {
        /// The kind of the error.
        kind: io::ErrorKind,
        /// The message of the operating system.
        message: String,
    },
    /// The path is a device, a pipe or a folder: only regular files are read.
    NotAFile,
    /// A file names another file outside the root folder.
    /// [`ReadOptions::with_root`](crate::ReadOptions::with_root) selects another root.
    Outside {
        /// The path of the named file.
        path: PathBuf,
        /// The root folder.
        root: PathBuf,
    },
    /// The input exceeds one of the [`Limits`](crate::Limits).
    Limit {
        /// The exceeded limit.
        limit: Limit,
        /// The value of the limit.
        allowed: usize,
    },
    /// No supported format has the extension of the file.
    UnknownFormat {
        /// The extension in lower case, without its dot; empty if the file has none.
        extension: String,
    },
    /// The file does not follow its format. Contains the message of the parser.
    Syntax(String),
    /// The library rejects the values of a shape, mesh or group, or the world rejects an object.
    Library(LibraryError),
    /// The recorder rejects an object.
    Record(RecordError),
    /// A point or vector has a wrong number of coordinates.
    WrongLength {
        /// The required number of coordinates.
        needed: usize,
        /// The number of coordinates in the file.
        given: usize,
    },
    /// The scene contains an element that exists in the other dimension only, such as a 2D rotation
    /// in a 3D scene.
    WrongDimension {
        /// The kind of element.
        what: &'static str,
        /// The dimension of the scene.
        dimension: Dimension,
    },
    /// The requested world has a different dimension than the scene.
    OtherWorld {
        /// The dimension of the scene.
        scene: Dimension,
        /// The requested dimension.
        asked: usize,
    },
    /// A number is outside the allowed values.
    BadValue {
        /// The kind of number, and its allowed values.
        what: &'static str,
        /// The number.
        value: f64,
    },
    /// An object has members that exclude each other, or not exactly one of several alternatives.
    /// The text names these members.
    Members(&'static str),
    /// No shape has this name.
    UnknownShape(String),
    /// A shape contains itself through the shapes with these names, the first of which is repeated
    /// at the end.
    ShapeCycle(Vec<String>),
    /// Two objects of a scene, or two joints of a robot, have this name.
    DuplicateName(String),
    /// The mesh file has no part of this name.
    UnknownPart(String),
    /// The mesh file has no valid triangle.
    EmptyMesh,
    /// A mesh with the kind `solid` is not the boundary of a volume.
    NotSolid {
        /// The number of edges that belong to one triangle only.
        boundary_edges: usize,
        /// The number of edges whose two triangles have their fronts on different sides.
        inconsistent_edges: usize,
        /// The number of edges that belong to more than two triangles.
        non_manifold_edges: usize,
    },
    /// A count exceeds the allowed maximum, such as the number of nested elements or of parts of a
    /// compound.
    TooMany {
        /// The kind of item that is counted.
        what: &'static str,
        /// The count in the file. If the exact count is unknown, the first value above the limit.
        given: usize,
        /// The maximum count that is accepted.
        limit: usize,
    },
    /// The robot has no movable joint with this name, or the joint mimics another joint.
    UnknownJoint(String),
    /// The robot has no link with this name.
    UnknownLink(String),
    /// The joints of a robot do not form a tree.
    NotATree {
        /// A link that has two parents, or that is not connected to the root.
        link: String,
    },
    /// The joint with this name mimics itself, directly or through other joints.
    MimicCycle(String),
    /// None of the searched folders contains this package.
    UnknownPackage(String),
}

impl FileError {
    /// Returns an error of a whole file.
    pub(crate) fn whole(file: impl Into<PathBuf>, problem: Problem) -> Self {
        let (file, path, problem) = (file.into(), String::new(), Box::new(problem));
        Self { file, line: None, column: None, path, value: None, problem }
    }
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", Printable(&self.file.to_string_lossy()))?;
        for number in [self.line, self.column].into_iter().flatten() {
            write!(f, ":{number}")?;
        }
        write!(f, ": ")?;
        if !self.path.is_empty() {
            write!(f, "{}: ", Printable(&self.path))?;
        }
        let problem = self.problem.to_string();
        write!(f, "{problem}")?;
        // The value is omitted if the message of the problem already contains it.
        match &self.value {
            Some(value) if !problem.contains(value.trim_matches('"')) => {
                write!(f, " (here: {})", Printable(value))
            }
            _ => Ok(()),
        }
    }
}

impl std::error::Error for FileError {}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io { message, .. } | Self::Syntax(message) => {
                write!(f, "{}", Printable(message))
            }
            Self::Library(error) => error.fmt(f),
            Self::Record(error) => error.fmt(f),
            Self::WrongLength { needed, given } => {
                write!(f, "{given} coordinates were given, {needed} are needed")
            }
            Self::WrongDimension { what, dimension } => {
                write!(f, "{what} does not exist in {}D", dimension.number())
            }
            Self::OtherWorld { scene, asked } => {
                write!(f, "the scene is of {}D, a world of {asked}D was asked for", scene.number())
            }
            Self::BadValue { what, value } => write!(f, "{what}: {value} is not"),
            Self::Members(rule) => write!(f, "{rule}"),
            Self::TooMany { what, given, limit } => {
                write!(f, "{given} {what} are more than {limit}")
            }
            Self::Limit { limit, allowed } => {
                write!(
                    f,
                    "more than {allowed} {limit}: `Limits::{}` raises the limit",
                    limit.name()
                )
            }
            Self::NotSolid { boundary_edges, inconsistent_edges, non_manifold_edges } => write!(
                f,
                "the surface encloses no volume: {boundary_edges} edges have one triangle, at \
                 {inconsistent_edges} the triangles disagree about the outside, {non_manifold_edges} have more \
                 than two triangles"
            ),
            _ => self.fmt_names(f),
        }
    }
}

impl Problem {
    /// Writes the messages that `fmt` leaves to this function, most of which are about a name.
    fn fmt_names(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownFormat { extension } if extension.is_empty() => {
                write!(f, "without an ending the name of the file does not say its format")
            }
            Self::UnknownFormat { extension } => {
                write!(f, "no format with the ending {} can be read", Quoted(extension))
            }
            Self::NotAFile => write!(f, "no regular file, and devices and pipes are not read"),
            Self::Outside { path, root } => {
                let [path, root] = [path, root].map(|path| path.to_string_lossy());
                let (path, root) = (Quoted(&path), Quoted(&root));
                write!(
                    f,
                    "the file {path} is outside of {root}, the root from which files are read"
                )
            }
            Self::UnknownShape(name) => write!(f, "no shape is named {}", Quoted(name)),
            Self::ShapeCycle(names) => {
                write!(f, "a shape holds itself: {}", Printable(&names.join(" holds ")))
            }
            Self::DuplicateName(name) => write!(f, "two objects are named {}", Quoted(name)),
            Self::UnknownPart(name) => write!(f, "the mesh file has no part {}", Quoted(name)),
            Self::UnknownJoint(name) => {
                write!(f, "the robot has no moving joint {}", Quoted(name))
            }
            Self::UnknownLink(name) => write!(f, "the robot has no link {}", Quoted(name)),
            Self::NotATree { link } => {
                let link = Quoted(link);
                write!(f, "the joints are no tree: link {link} has two parents or no root")
            }
            Self::MimicCycle(name) => write!(f, "the joint {} mimics itself", Quoted(name)),
            Self::UnknownPackage(name) => {
                write!(f, "none of the package folders holds a package {}", Quoted(name))
            }
            _ => write!(f, "no triangle of the mesh can be used"),
        }
    }

    /// Returns an error with the message of a parser, which may quote the file.
    pub(crate) fn syntax(words: impl fmt::Display) -> Self {
        Self::Syntax(text::message(&words.to_string()))
    }

    /// Returns the error of a failed read.
    pub(crate) fn io(error: &io::Error) -> Self {
        Self::Io { kind: error.kind(), message: error.to_string() }
    }

    /// Converts an error of a recorder. An error of the world in the recorder becomes
    /// [`Self::Library`], as without a recorder.
    pub(crate) fn recorded(error: RecordError) -> Self {
        match error {
            RecordError::World(error) => error.into(),
            error => Self::Record(error),
        }
    }
}

impl<E: Into<LibraryError>> From<E> for Problem {
    fn from(error: E) -> Self {
        Self::Library(error.into())
    }
}

/// A problem and its path in a document, before the file and the line are known.
///
/// The path is empty where the problem is found. Each caller that descended to a member prepends
/// the name of that member.
#[derive(Clone, Debug)]
pub(crate) struct Fault {
    pub(crate) path: String,
    /// `true` if the path already begins at the root of the document, as for a named shape. Callers
    /// then prepend nothing.
    pub(crate) is_absolute: bool,
    pub(crate) problem: Problem,
}

impl Fault {
    /// Marks the path as starting at the root of the document, so that callers prepend nothing.
    pub(crate) const fn absolute(mut self) -> Self {
        self.is_absolute = true;
        self
    }

    /// Prepends the member name or index `step` to the path, unless the path is absolute.
    pub(crate) fn within(mut self, step: &str) -> Self {
        if self.is_absolute {
            return self;
        }
        let separator = if self.path.is_empty() || self.path.starts_with('[') { "" } else { "." };
        self.path = format!("{step}{separator}{}", self.path);
        self
    }
}

impl<P: Into<Problem>> From<P> for Fault {
    fn from(problem: P) -> Self {
        Self { path: String::new(), is_absolute: false, problem: problem.into() }
    }
}

/// Prepends a member name or an index to the path of an error in a result.
pub(crate) trait Within<T> {
    /// Prepends the member name or index `step` to the path of the error.
    fn within(self, step: &str) -> Result<T, Fault>;
}

impl<T, E: Into<Fault>> Within<T> for Result<T, E> {
    fn within(self, step: &str) -> Result<T, Fault> {
        self.map_err(|error| error.into().within(step))
    }
}

//! Why a file cannot be used, and where in it.

use core::fmt;
use std::io;
use std::path::PathBuf;

use impinge_record::{LibraryError, RecordError};

use crate::text::{self, Printable, Quoted};
use crate::{Dimension, Limit};

/// Why a file cannot be used: the file, the place in it as far as it is known, and what is wrong there.
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
    /// The file, as it was named.
    pub file: PathBuf,
    /// The line, counted from 1; `None` for binary formats, and where it is not known.
    pub line: Option<usize>,
    /// The column in characters, counted from 1.
    pub column: Option<usize>,
    /// The path in the document, such as `objects[3].shape.ball.radius`; empty for the whole file.
    pub path: String,
    /// The text that stands there, in one line and shortened.
    pub value: Option<String>,
    /// What is wrong; boxed, so that results stay small.
    pub problem: Box<Problem>,
}

/// What is wrong with a file.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Problem {
    /// The file cannot be read.
    Io {
        /// The kind of the error.
        kind: io::ErrorKind,
        /// The error of the system in words.
        message: String,
    },
    /// It is a device, a pipe or a folder: only regular files are read.
    NotAFile,
    /// A file names one outside of the folder from which files are read;
    /// [`ReadOptions::with_root`](crate::ReadOptions::with_root) allows another folder.
    Outside {
        /// The file that is named.
        path: PathBuf,
        /// The folder from which files are read.
        root: PathBuf,
    },
    /// More than one of the [`Limits`](crate::Limits) allows.
    Limit {
        /// Which one.
        limit: Limit,
        /// How many there may be.
        allowed: usize,
    },
    /// The ending of the file's name is of no format that can be read.
    UnknownFormat {
        /// The ending without its dot; empty if there is none.
        extension: String,
    },
    /// The file is not of its format, in the words of the parser.
    Syntax(String),
    /// The library refuses the numbers of a shape, mesh or group, or the world an object.
    Library(LibraryError),
    /// The recorder refuses an object.
    Record(RecordError),
    /// A point or vector has another number of coordinates.
    WrongLength {
        /// How many it takes.
        needed: usize,
        /// How many were given.
        given: usize,
    },
    /// Something of one dimension in a scene of the other.
    WrongDimension {
        /// What it is.
        what: &'static str,
        /// The dimension of the scene.
        dimension: Dimension,
    },
    /// A world of another dimension than the scene's is asked for.
    OtherWorld {
        /// The dimension of the scene.
        scene: Dimension,
        /// The dimension that is asked for.
        asked: usize,
    },
    /// A number that cannot be used.
    BadValue {
        /// What it is, and what it must be.
        what: &'static str,
        /// The number.
        value: f64,
    },
    /// Members that exclude each other, or of which one is needed.
    Members(&'static str),
    /// No shape has this name.
    UnknownShape(String),
    /// A shape holds itself, by way of these names.
    ShapeCycle(Vec<String>),
    /// Two objects have this name.
    DuplicateName(String),
    /// The mesh file has no part of this name.
    UnknownPart(String),
    /// Nothing of a mesh file can be used: no triangle is left.
    EmptyMesh,
    /// A mesh that should be solid is not.
    NotSolid {
        /// How many edges have one triangle.
        boundary_edges: usize,
        /// How many edges have triangles that disagree about the outside.
        inconsistent_edges: usize,
        /// How many edges have more than two triangles.
        non_manifold_edges: usize,
    },
    /// More than can be held.
    TooMany {
        /// Of what.
        what: &'static str,
        /// How many there would be.
        given: usize,
        /// How many there may be.
        limit: usize,
    },
    /// The robot has no joint of this name, or none that moves.
    UnknownJoint(String),
    /// The robot has no link of this name.
    UnknownLink(String),
    /// The joints of a robot are no tree.
    NotATree {
        /// A link that has two parents, or of which none leads to the root.
        link: String,
    },
    /// A joint mimics itself, by way of others.
    MimicCycle(String),
    /// None of the folders holds this package.
    UnknownPackage(String),
}

impl FileError {
    /// An error of a whole file.
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
        // The words of a problem often hold the value already.
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
    /// The problems that are about a name.
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

    /// An error in the words of a parser, which may quote the file.
    pub(crate) fn syntax(words: impl fmt::Display) -> Self {
        Self::Syntax(text::message(&words.to_string()))
    }

    /// The error of reading a file.
    pub(crate) fn io(error: &io::Error) -> Self {
        Self::Io { kind: error.kind(), message: error.to_string() }
    }

    /// The error of a recorder. What its world refuses is the same as without a recorder.
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

/// A problem at a path of a document, before the file and the line are known.
///
/// It begins with an empty path where the problem is found. Each caller that went down by a member puts this in front.
#[derive(Clone, Debug)]
pub(crate) struct Fault {
    pub(crate) path: String,
    /// The path begins at the document: a shape that is used by its name.
    pub(crate) is_absolute: bool,
    pub(crate) problem: Problem,
}

impl Fault {
    /// The same, with a path that counts from the document.
    pub(crate) const fn absolute(mut self) -> Self {
        self.is_absolute = true;
        self
    }

    /// The fault seen from a value that holds the one it is in, by this member or index.
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

/// Where a result belongs.
pub(crate) trait Within<T> {
    /// The result of reading a member.
    fn within(self, step: &str) -> Result<T, Fault>;
}

impl<T, E: Into<Fault>> Within<T> for Result<T, E> {
    fn within(self, step: &str) -> Result<T, Fault> {
        self.map_err(|error| error.into().within(step))
    }
}

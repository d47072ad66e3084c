//! Mesh files: their parts, and the defects of the parts.

mod accessor;
mod buffers;
mod gltf;
mod obj;
mod ply;
mod raw;
mod repair;
mod report;
mod stl;
mod topology;
mod triangulate;

use std::collections::BTreeMap;
use std::path::Path;

pub use report::{Defect, Defects, MAX_DEFECTS, MeshReport};

use self::raw::{FormatError, RawPart};
use crate::files::{Files, extension};
use crate::text::without_mark;
use crate::{FileError, Problem, ReadOptions};

/// The parts of a mesh file: the groups and objects of an OBJ file, the meshes of the nodes of a
/// glTF file, or the solids of an STL file. A PLY file has one part.
///
/// ```
/// use impinge_files::MeshFile;
///
/// let square = "o square\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
/// let file = MeshFile::parse("square.obj".as_ref(), square.as_bytes())?;
/// let [part] = file.parts() else { panic!("one object") };
/// assert_eq!((part.name.as_str(), part.triangles.len()), ("square", 2));
/// assert_eq!((part.report.polygons, part.report.boundary_edges.count), (1, 4));
/// assert!(!part.report.is_closed());
/// # Ok::<(), impinge_files::FileError>(())
/// ```
#[derive(Clone, Debug)]
pub struct MeshFile {
    parts: Vec<MeshPart>,
    /// The index of each part by its name.
    names: BTreeMap<String, usize>,
}

/// A part of a mesh file: triangles with finite, shared vertices.
#[derive(Clone, Debug)]
pub struct MeshPart {
    /// The name in the file, or `part` if there is none. If an earlier part has the name, a suffix
    /// with a number is added.
    pub name: String,
    /// The vertices, in the frame of the file. No two are equal.
    pub vertices: Vec<[f64; 3]>,
    /// The vertex indices of each triangle, counter-clockwise seen from the front. No triangle has
    /// zero area.
    pub triangles: Vec<[u32; 3]>,
    /// The defects, and their repairs.
    pub report: MeshReport,
}

impl MeshFile {
    /// Reads a file by its extension: .obj, .stl, .ply, .gltf or .glb. Buffers of a glTF file are
    /// read from the folder of the file.
    ///
    /// Vertices at equal positions are welded, and polygons are triangulated. Triangles that are
    /// degenerate or duplicate, and faces with a vertex that does not exist or is not finite, are
    /// dropped. [`MeshPart::report`] counts these changes. Coordinates are unchanged: usually
    /// meters, with y or z upwards. Time is O(n log n) and memory O(n) in the bytes of the file,
    /// and in the vertices and corners that the nodes of a glTF file create.
    ///
    /// # Errors
    /// If the file cannot be read, is not of its format, names a file outside of its folder,
    /// exceeds the default [`Limits`](crate::Limits), or has no valid triangle. The error has the
    /// line, if the format has lines.
    pub fn read(path: &Path) -> Result<Self, FileError> {
        Self::read_with(path, &ReadOptions::new())
    }

    /// Reads a file like [`Self::read`], with options for the root folder and the limits.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn read_with(path: &Path, options: &ReadOptions) -> Result<Self, FileError> {
        let mut files = Files::beside(path, options);
        let bytes = files.read_named(path)?;
        Self::of_bytes(path, &bytes, &mut files)
    }

    /// Parses the bytes of a file. The extension of `path` selects the format, and the folder of
    /// `path` contains the buffers of a glTF file.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn parse(path: &Path, bytes: &[u8]) -> Result<Self, FileError> {
        let mut files = Files::beside(path, &ReadOptions::new());
        files.count_bytes(bytes.len()).map_err(|problem| FileError::whole(path, problem))?;
        Self::of_bytes(path, bytes, &mut files)
    }

    /// Parses the bytes of a file, and reads the files that it names.
    pub(crate) fn of_bytes(
        path: &Path,
        bytes: &[u8],
        files: &mut Files,
    ) -> Result<Self, FileError> {
        let extension = extension(path);
        let Some(read) = reader(&extension) else {
            return Err(FileError::whole(path, Problem::UnknownFormat { extension }));
        };
        let raw = read(path, bytes, files).and_then(|raw| {
            raw.iter().try_for_each(|part| part.check_corners(files.limits.corners))?;
            Ok(raw)
        });
        let raw = raw.map_err(|FormatError { line, problem }| FileError {
            line,
            ..FileError::whole(path, problem)
        })?;
        let parts = raw.into_iter().map(repair::repaired).filter(|part| !part.is_empty());
        let mut parts: Vec<MeshPart> = parts.collect();
        if parts.iter().all(|part| part.triangles.is_empty()) {
            return Err(FileError::whole(path, Problem::EmptyMesh));
        }
        let names = unique_names(&mut parts);
        Ok(Self { parts, names })
    }

    /// Returns `true` if the format with this extension is supported.
    pub(crate) fn has_format(extension: &str) -> bool {
        reader(extension).is_some()
    }

    /// Returns the parts in the order of the file. At least one has a triangle.
    #[must_use]
    pub fn parts(&self) -> &[MeshPart] {
        &self.parts
    }

    /// Returns the part with this name.
    #[must_use]
    pub fn part(&self, name: &str) -> Option<&MeshPart> {
        self.names.get(name).map(|index| &self.parts[*index])
    }
}

/// A function that reads the parts of a mesh file from its path and bytes, and from the files that
/// it names.
type Reader = fn(&Path, &[u8], &mut Files) -> Result<Vec<RawPart>, FormatError>;

/// Returns the reader for a file extension; `None` if the format is not supported.
fn reader(extension: &str) -> Option<Reader> {
    Some(match extension {
        "obj" => |_, bytes, _| obj::read(without_mark(bytes)),
        "stl" => |_, bytes, _| stl::read(bytes),
        "ply" => |_, bytes, _| ply::read(without_mark(bytes)),
        "gltf" | "glb" => |path, bytes, files| gltf::read(path, without_mark(bytes), files),
        _ => return None,
    })
}

impl MeshPart {
    /// Returns `true` if the part has no triangles, and no defects to report.
    fn is_empty(&self) -> bool {
        self.triangles.is_empty() && self.report.is_clean()
    }
}

/// Makes the names of parts unique, and returns the index of the part with each name. O(n log n).
fn unique_names(parts: &mut [MeshPart]) -> BTreeMap<String, usize> {
    let mut names = BTreeMap::new();
    // The next suffix to try for each name. All smaller suffixes are taken.
    let mut next: BTreeMap<String, usize> = BTreeMap::new();
    for (index, part) in parts.iter_mut().enumerate() {
        if part.name.is_empty() {
            part.name.push_str("part");
        }
        if names.contains_key(&part.name) {
            let stem = core::mem::take(&mut part.name);
            let number = next.entry(stem.clone()).or_insert(2);
            // Terminates: finitely many names exist, so some suffix is free.
            part.name = loop {
                let name = format!("{stem}.{number}");
                *number += 1;
                if !names.contains_key(&name) {
                    break name;
                }
            };
        }
        names.insert(part.name.clone(), index);
    }
    names
}

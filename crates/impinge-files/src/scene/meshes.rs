//! The mesh files of a scene, and the shapes built from their triangles.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use impinge::math::{Point, Pose, Vector};
use impinge::shape::{Compound, MeshError, ShapeHandle, TriMesh};

use super::SceneSpace;
use crate::error::{Fault, Within};
use crate::files::Files;
use crate::format::{MeshKind, MeshSource, RobotFile, ScaleFile, ShapeFile, ShapeRef};
use crate::robot::Robot;
use crate::{Dimension, FileError, MeshFile, MeshPart, Problem};

/// The mesh files that were read, by path. Each file is read once. Clones share the data of the
/// files.
#[derive(Clone, Debug)]
pub(crate) struct MeshTable {
    folder: PathBuf,
    /// The reader of all files of the scene.
    pub(crate) files: Files,
    meshes: BTreeMap<PathBuf, Named>,
    /// The path without symbolic links, for each path that was read.
    real: BTreeMap<PathBuf, PathBuf>,
}

/// A mesh file, and the first path by which it was named.
#[derive(Clone, Debug)]
struct Named {
    path: PathBuf,
    mesh: Arc<MeshFile>,
}

impl MeshTable {
    /// Creates a table without meshes. Paths are relative to `folder`.
    pub(crate) fn new(folder: &Path, files: Files) -> Self {
        let (meshes, real) = (BTreeMap::new(), BTreeMap::new());
        Self { folder: folder.to_owned(), files, meshes, real }
    }

    /// Returns the mesh file at a path. The file is read at the first call.
    pub(crate) fn read(&mut self, path: &Path) -> Result<&MeshFile, FileError> {
        let path = self.folder.join(path);
        if !self.real.contains_key(&path) {
            let real = self.files.locate(&path);
            let real = real.map_err(|problem| FileError::whole(&path, problem))?;
            self.read_new(&path, &real)?;
            self.real.insert(path.clone(), real);
        }
        Ok(&self.meshes[&self.real[&path]].mesh)
    }

    /// Reads the URDF and SRDF files of a robot, but not its meshes.
    pub(crate) fn read_robot(&mut self, robot: &RobotFile) -> Result<Robot, FileError> {
        Robot::read(robot, &self.folder, &mut self.files)
    }

    /// Reads a file, unless it was read before through another path.
    fn read_new(&mut self, path: &Path, real: &Path) -> Result<(), FileError> {
        if !self.meshes.contains_key(real) {
            let bytes = self.files.read_named(path)?;
            let mesh = Arc::new(MeshFile::of_bytes(path, &bytes, &mut self.files)?);
            self.meshes.insert(real.to_owned(), Named { path: path.to_owned(), mesh });
        }
        Ok(())
    }

    /// Reads all mesh files of a shape and of the inline shapes in it. A named shape is skipped,
    /// since it is read with the `shapes` of the document.
    pub(crate) fn read_all(&mut self, shape: &ShapeRef) -> Result<(), FileError> {
        match shape {
            ShapeRef::Name(_) => Ok(()),
            ShapeRef::Inline(shape) => self.read_files(shape),
        }
    }

    /// Reads all mesh files of a shape and of the inline shapes in it.
    pub(crate) fn read_files(&mut self, shape: &ShapeFile) -> Result<(), FileError> {
        match shape {
            ShapeFile::MeshFile(source) => self.read(&source.path).map(|_| ()),
            ShapeFile::Rounded { shape, .. } => self.read_all(shape),
            ShapeFile::Compound { children } => {
                children.iter().try_for_each(|child| self.read_all(&child.shape))
            }
            _ => Ok(()),
        }
    }

    /// Returns the files that were read, with their paths.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (&Path, &MeshFile)> {
        self.meshes.values().map(|Named { path, mesh }| (path.as_path(), &**mesh))
    }

    /// Builds the shape of a mesh file that was read before.
    pub(crate) fn shape<N: SceneSpace<D>, const D: usize>(
        &self,
        source: &MeshSource,
    ) -> Result<ShapeHandle<N, D>, Fault> {
        let dimension = Dimension::Two;
        if D == dimension.number() {
            return Err(Problem::WrongDimension { what: "a mesh file", dimension }.into());
        }
        let parts = self.parts(source)?;
        let triangles = Triangles { parts, scale: scale(source.scale).within("scale")? };
        match source.kind {
            MeshKind::Surface => Ok(ShapeHandle::new(triangles.mesh(false)?)),
            MeshKind::OneSided => Ok(ShapeHandle::new(N::one_sided_mesh(triangles.mesh(false)?))),
            MeshKind::Solid => {
                triangles.check_solid().within("as")?;
                Ok(ShapeHandle::new(N::solid_mesh(triangles.mesh(true)?)?))
            }
            MeshKind::ConvexHull => triangles.hull(&triangles.parts),
            MeshKind::ConvexParts => triangles.hulls(),
        }
    }
}

impl MeshTable {
    /// Returns the parts of a file from which a shape is built. The file must have been read. It is
    /// an error if the file has no part with the given name.
    fn parts(&self, source: &MeshSource) -> Result<Vec<&MeshPart>, Fault> {
        let real = &self.real[&self.folder.join(&source.path)];
        let file = &self.meshes[real].mesh;
        match &source.part {
            None => Ok(file.parts().iter().collect()),
            Some(name) => {
                let part = file.part(name).ok_or_else(|| Problem::UnknownPart(name.clone()));
                Ok(vec![part.within("part")?])
            }
        }
    }

    /// Returns the number of vertices plus the number of triangle corners of the parts that
    /// `source` selects.
    pub(crate) fn elements(&self, source: &MeshSource) -> Result<usize, Fault> {
        let parts = self.parts(source)?.into_iter();
        Ok(parts.map(|part| part.vertices.len() + 3 * part.triangles.len()).sum())
    }
}

/// Returns the scale factors along the axes; an error if one is zero or not finite.
fn scale(scale: ScaleFile) -> Result<[f64; 3], Problem> {
    let factors = scale.factors();
    match factors.into_iter().find(|factor| *factor == 0.0 || !factor.is_finite()) {
        Some(value) => {
            Err(Problem::BadValue { what: "a scale must be finite and not zero", value })
        }
        None => Ok(factors),
    }
}

/// The triangles of some parts of a file, and the factors that scale them to the frame of the
/// shape.
struct Triangles<'a> {
    parts: Vec<&'a MeshPart>,
    scale: [f64; 3],
}

impl Triangles<'_> {
    /// Returns a vertex in the frame of the shape.
    fn place<N: SceneSpace<D>, const D: usize>(&self, vertex: &[f64; 3]) -> Point<N, D> {
        Vector::<N, D>::from_fn(|axis, _| N::lit(vertex[axis] * self.scale[axis])).into()
    }

    /// Builds one mesh of all parts.
    ///
    /// Triangles keep their fronts: if the scale mirrors, their corners are reversed. With
    /// `turns_outwards`, the triangles of parts that point inwards (negative volume) are reversed
    /// too.
    fn mesh<N: SceneSpace<D>, const D: usize>(
        &self,
        turns_outwards: bool,
    ) -> Result<TriMesh<N, D>, MeshError> {
        let is_mirrored = self.scale.iter().product::<f64>() < 0.0;
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        for part in &self.parts {
            let first = u32::try_from(vertices.len()).unwrap_or(u32::MAX);
            vertices.extend(part.vertices.iter().map(|vertex| self.place(vertex)));
            let is_inside_out = part.report.volume.is_some_and(|volume| volume < 0.0);
            let is_turned = (turns_outwards && is_inside_out) != is_mirrored;
            triangles.extend(part.triangles.iter().map(|corners| {
                let [a, b, c] = corners.map(|corner| first.saturating_add(corner));
                if is_turned { [a, c, b] } else { [a, b, c] }
            }));
        }
        TriMesh::try_new(vertices, triangles)
    }

    /// Builds the convex hull of all vertices of some parts.
    fn hull<N: SceneSpace<D>, const D: usize>(
        &self,
        parts: &[&MeshPart],
    ) -> Result<ShapeHandle<N, D>, Fault> {
        let vertices = parts.iter().flat_map(|part| &part.vertices);
        let points: Vec<Point<N, D>> = vertices.map(|vertex| self.place(vertex)).collect();
        Ok(N::convex_hull(&points)?)
    }

    /// Builds a compound of the convex hulls of all parts that have triangles.
    fn hulls<N: SceneSpace<D>, const D: usize>(&self) -> Result<ShapeHandle<N, D>, Fault> {
        let at = N::isometry(&Pose::identity());
        let parts = self.parts.iter().filter(|part| !part.triangles.is_empty());
        let hulls = parts.map(|part| Ok((at, self.hull(&[part])?)));
        Ok(ShapeHandle::new(Compound::try_new(hulls.collect::<Result<_, Fault>>()?)?))
    }

    /// Returns an error unless each part that has triangles is the boundary of a volume. The faces
    /// of the other parts were dropped, so they add nothing to the mesh.
    fn check_solid(&self) -> Result<(), Problem> {
        let reports = self.parts.iter().map(|part| &part.report);
        match reports.into_iter().find(|report| report.triangles > 0 && !report.is_solid()) {
            None => Ok(()),
            Some(report) => Err(Problem::NotSolid {
                boundary_edges: report.boundary_edges.count,
                inconsistent_edges: report.inconsistent_edges.count,
                non_manifold_edges: report.non_manifold_edges.count,
            }),
        }
    }
}

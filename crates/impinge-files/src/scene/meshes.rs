//! The mesh files of a scene, and the shapes that their triangles stand for.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use impinge::math::Point;
use impinge::shape::{Compound, ShapeHandle, TriMesh};

use super::SceneSpace;
use super::pose::Placement;
use crate::error::{Fault, Within};
use crate::format::{MeshKind, MeshSource, ShapeFile, ShapeRef};
use crate::{Dimension, FileError, MeshFile, MeshPart, Problem};

/// Files by path, each read once.
#[derive(Clone, Debug, Default)]
pub(crate) struct MeshTable {
    folder: PathBuf,
    files: BTreeMap<PathBuf, MeshFile>,
}

impl MeshTable {
    /// Without files; paths are relative to a folder.
    pub(crate) fn new(folder: &Path) -> Self {
        Self { folder: folder.to_owned(), files: BTreeMap::new() }
    }

    /// The file of a path, read if it was not.
    pub(crate) fn read(&mut self, path: &Path) -> Result<&MeshFile, FileError> {
        let path = self.folder.join(path);
        if !self.files.contains_key(&path) {
            let file = MeshFile::read(&path)?;
            self.files.insert(path.clone(), file);
        }
        Ok(&self.files[&path])
    }

    /// Reads all files that a shape and those within it name.
    pub(crate) fn read_all(&mut self, shape: &ShapeFile) -> Result<(), FileError> {
        match shape {
            ShapeFile::MeshFile(source) => self.read(&source.path).map(|_| ()),
            ShapeFile::Rounded { shape: ShapeRef::Inline(shape), .. } => self.read_all(shape),
            ShapeFile::Compound { children } => {
                let shapes = children.iter().filter_map(|child| child.shape.inline());
                shapes.into_iter().try_for_each(|shape| self.read_all(shape))
            }
            _ => Ok(()),
        }
    }

    /// The files that were read, by path.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (&Path, &MeshFile)> {
        self.files.iter().map(|(path, file)| (path.as_path(), file))
    }

    /// The shape of a file that was read.
    pub(crate) fn shape<N: SceneSpace<D>, const D: usize>(
        &self,
        source: &MeshSource,
    ) -> Result<ShapeHandle<N, D>, Fault> {
        let (what, dimension) = ("a mesh file", Dimension::Two);
        if D == dimension.number() {
            return Err(Problem::WrongDimension { what, dimension }.into());
        }
        let path = self.folder.join(&source.path);
        let file = self.files.get(&path).ok_or(Problem::EmptyMesh).within("path")?;
        let parts: Vec<&MeshPart> = match &source.part {
            None => file.parts().iter().collect(),
            Some(name) => {
                let part = file.part(name).ok_or_else(|| Problem::UnknownPart(name.clone()));
                vec![part.within("part")?]
            }
        };
        let scale = scale(source.scale.factors()).within("scale")?;
        let place = move |vertex: &[f64; 3]| {
            Point::from(impinge::math::Vector::from_fn(|axis, _| {
                N::lit(vertex[axis] * scale[axis])
            }))
        };
        let is_mirrored = scale.iter().product::<f64>() < 0.0;
        let triangles = Triangles { parts, place, is_mirrored };
        match source.kind {
            MeshKind::Surface => triangles.mesh(),
            MeshKind::OneSided => Ok(one_sided(&triangles.mesh()?)),
            MeshKind::Solid => {
                triangles.check_solid().within("as")?;
                Ok(one_sided(&triangles.mesh()?))
            }
            MeshKind::ConvexHull => triangles.hull(&triangles.parts),
            MeshKind::ConvexParts => triangles.hulls(),
        }
    }
}

impl ShapeRef {
    /// The shape that is written here.
    pub(crate) fn inline(&self) -> Option<&ShapeFile> {
        match self {
            Self::Name(_) => None,
            Self::Inline(shape) => Some(shape),
        }
    }
}

/// Factors that are finite and not zero.
fn scale(factors: [f64; 3]) -> Result<[f64; 3], Problem> {
    match factors.into_iter().find(|factor| *factor == 0.0 || !factor.is_finite()) {
        Some(value) => {
            Err(Problem::BadValue { what: "a scale must be finite and not zero", value })
        }
        None => Ok(factors),
    }
}

fn one_sided<N: SceneSpace<D>, const D: usize>(shape: &ShapeHandle<N, D>) -> ShapeHandle<N, D> {
    let mesh = shape.as_shape::<TriMesh<N, D>>();
    mesh.map_or_else(|| shape.clone(), |mesh| ShapeHandle::new(N::one_sided_mesh(mesh.clone())))
}

/// The triangles of some parts, placed in the frame of the shape.
struct Triangles<'a, F> {
    parts: Vec<&'a MeshPart>,
    place: F,
    /// The scale turns triangles over.
    is_mirrored: bool,
}

impl<F> Triangles<'_, F> {
    /// All parts as one mesh. Parts that are solid and inside out are turned if it shall be solid.
    fn mesh<N: SceneSpace<D>, const D: usize>(&self) -> Result<ShapeHandle<N, D>, Fault>
    where
        F: Fn(&[f64; 3]) -> Point<N, D>,
    {
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        for part in &self.parts {
            let first = u32::try_from(vertices.len()).unwrap_or(u32::MAX);
            vertices.extend(part.vertices.iter().map(&self.place));
            let is_inside_out = part.report.volume.is_some_and(|volume| volume < 0.0);
            let is_turned = is_inside_out != self.is_mirrored;
            triangles.extend(part.triangles.iter().map(|corners| {
                let [a, b, c] = corners.map(|corner| first.saturating_add(corner));
                if is_turned { [a, c, b] } else { [a, b, c] }
            }));
        }
        Ok(ShapeHandle::new(TriMesh::try_new(vertices, triangles)?))
    }

    fn hull<N: SceneSpace<D>, const D: usize>(
        &self,
        parts: &[&MeshPart],
    ) -> Result<ShapeHandle<N, D>, Fault>
    where
        F: Fn(&[f64; 3]) -> Point<N, D>,
    {
        let vertices = parts.iter().flat_map(|part| &part.vertices);
        let points: Vec<Point<N, D>> = vertices.map(&self.place).collect();
        Ok(N::convex_hull(&points)?)
    }

    /// The hull of each part that has triangles.
    fn hulls<N: SceneSpace<D>, const D: usize>(&self) -> Result<ShapeHandle<N, D>, Fault>
    where
        F: Fn(&[f64; 3]) -> Point<N, D>,
    {
        let at = Placement::identity(Dimension::Three).isometry::<N, D>();
        let at = at.ok_or(Problem::OtherWorld { scene: Dimension::Three, asked: D })?;
        let parts = self.parts.iter().filter(|part| !part.triangles.is_empty());
        let hulls = parts.map(|part| Ok((at, self.hull(&[part])?)));
        Ok(ShapeHandle::new(Compound::try_new(hulls.collect::<Result<_, Fault>>()?)?))
    }

    fn check_solid(&self) -> Result<(), Problem> {
        let reports = self.parts.iter().map(|part| &part.report);
        match reports.into_iter().find(|report| !report.is_solid()) {
            None => Ok(()),
            Some(report) => Err(Problem::NotSolid {
                boundary_edges: report.boundary_edges.count,
                inconsistent_edges: report.inconsistent_edges.count,
                non_manifold_edges: report.non_manifold_edges.count,
            }),
        }
    }
}

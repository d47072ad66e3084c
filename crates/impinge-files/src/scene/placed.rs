//! Converts the objects of a scene to the scalar and dimension of a world.

use impinge::narrow_phase::GeometricQueryType;
use impinge::shape::ShapeHandle;
use impinge::world::{CollisionWorld, WorldError};
use impinge_record::LibraryError;

use super::shapes::Builder;
use super::{MeshTable, Scene, SceneObject, SceneSpace};
use crate::error::{Fault, Within};
use crate::format::{QueryTypeFile, ShapeFile, ShapeRef};
use crate::{FileError, Problem};

/// An object, and the arguments with which it is added to a world.
pub(super) struct PlacedObject<'a, N: SceneSpace<D>, const D: usize> {
    pub(super) object: &'a SceneObject,
    pub(super) position: N::Isometry,
    pub(super) shape: ShapeHandle<N, D>,
    pub(super) query: GeometricQueryType<N>,
}

impl Scene {
    /// Creates a collision world with the objects in their order. The world is not updated yet. The
    /// data of an object is its name.
    ///
    /// Objects that share a shape in the document share a handle. The cost is the cost of building
    /// the shapes, plus O(log n) for each object.
    ///
    /// # Errors
    /// If the dimension differs from that of the scene, or if the library rejects a shape, a
    /// position, a query type or the margin. The error has the line of the value.
    pub fn collision_world<N: SceneSpace<D>, const D: usize>(
        &self,
    ) -> Result<CollisionWorld<N, D, String>, FileError> {
        let world = CollisionWorld::try_new(N::lit(self.file.margin)).within("margin");
        let mut world = world.map_err(|fault| self.source.error(fault))?;
        for placed in self.placed::<N, D>()? {
            let PlacedObject { object, position, shape, query } = placed;
            let added = world.try_add(position, shape, object.groups, query, object.name.clone());
            added.map_err(|error| self.refused(object, error.into()))?;
        }
        Ok(world)
    }

    /// Builds a shape for queries from its name in the document, or from JSON as in a scene file.
    ///
    /// ```
    /// use impinge_files::Scene;
    ///
    /// let text = r#"{"dimension": 3, "shapes": {"wheel": {"cylinder": {"half_height": 0.1, "radius": 0.3}}}}"#;
    /// let scene = Scene::from_json("car.json", text)?;
    /// assert!(scene.shape::<f64, 3>("wheel").is_ok());
    /// assert!(scene.shape::<f64, 3>(r#"{"ball": {"radius": 1}}"#).is_ok());
    /// assert!(scene.shape::<f64, 3>("whel").is_err());
    /// # Ok::<(), impinge_files::FileError>(())
    /// ```
    ///
    /// # Errors
    /// If the dimension differs from that of the scene, there is no such shape, the JSON is not
    /// that of a shape, the library rejects its values, or a mesh file that the JSON names cannot
    /// be read.
    pub fn shape<N: SceneSpace<D>, const D: usize>(
        &self,
        shape: &str,
    ) -> Result<ShapeHandle<N, D>, FileError> {
        self.check_dimension(D)?;
        let shape = shape.trim();
        let file = match shape.starts_with('{') {
            false => ShapeRef::Name(shape.to_owned()),
            true => {
                let parsed = serde_json::from_str::<ShapeFile>(shape);
                let wrong = |error: serde_json::Error| self.whole(Problem::syntax(error));
                ShapeRef::Inline(Box::new(parsed.map_err(wrong)?))
            }
        };
        // The copy of the table shares the files of the scene, and also reads files that only this
        // shape names.
        let mut meshes = self.meshes.clone();
        meshes.read_all(&file)?;
        self.builder(&meshes).make(&file).map_err(|fault| match fault.is_absolute {
            true => self.source.error(fault),
            false => FileError { path: fault.path, ..self.whole(fault.problem) },
        })
    }

    /// Returns the objects, converted for a world of this scalar and dimension.
    pub(super) fn placed<N: SceneSpace<D>, const D: usize>(
        &self,
    ) -> Result<Vec<PlacedObject<'_, N, D>>, FileError> {
        self.check_dimension(D)?;
        let placed = self.shapes().and_then(|shapes: Vec<ShapeHandle<N, D>>| {
            let objects = self.objects.iter();
            objects.map(|object| self.place(object, shapes[object.form].clone())).collect()
        });
        placed.map_err(|fault| self.source.error(fault))
    }

    /// Builds the shape of each form. Named shapes are built even if no object uses them; their
    /// errors contain the path of the named shape.
    fn shapes<N: SceneSpace<D>, const D: usize>(&self) -> Result<Vec<ShapeHandle<N, D>>, Fault> {
        let mut builder = self.builder(&self.meshes);
        for name in self.file.shapes.keys() {
            builder.make(&ShapeRef::Name(name.clone()))?;
        }
        let forms = self.forms.iter().map(|form| {
            let made = builder.make(&form.shape);
            if form.member.is_empty() {
                // The path within the shape is dropped, since the document does not contain the
                // shape of a part or link.
                return made.map_err(|fault| Fault::from(fault.problem).within(&form.path));
            }
            made.within(form.member).within(&form.path)
        });
        forms.collect()
    }

    /// Returns a builder of the shapes of the document, with the mesh files of a table.
    pub(super) fn builder<'a, N: SceneSpace<D>, const D: usize>(
        &'a self,
        meshes: &'a MeshTable,
    ) -> Builder<'a, N, D> {
        Builder::new(self.file.dimension, &self.file.shapes, meshes)
    }

    fn place<'a, N: SceneSpace<D>, const D: usize>(
        &self,
        object: &'a SceneObject,
        shape: ShapeHandle<N, D>,
    ) -> Result<PlacedObject<'a, N, D>, Fault> {
        let position = object.start.isometry::<N, D>()?;
        let query = match object.query {
            QueryTypeFile::Contacts { linear, angular } => {
                GeometricQueryType::Contacts(N::lit(linear), N::lit(angular))
            }
            QueryTypeFile::Proximity(margin) => GeometricQueryType::Proximity(N::lit(margin)),
        };
        Ok(PlacedObject { object, position, shape, query })
    }

    /// Returns the error for an object that the world rejects.
    pub(super) fn refused(&self, object: &SceneObject, problem: Problem) -> FileError {
        let member = match &problem {
            Problem::Library(LibraryError::World(WorldError::Position { .. })) => Some("position"),
            Problem::Library(LibraryError::World(WorldError::QueryType { .. })) => Some("query"),
            _ => None,
        };
        let fault = Fault::from(problem);
        let fault = member.into_iter().fold(fault, Fault::within);
        self.source.error(fault.within(&self.forms[object.form].path))
    }

    pub(super) fn check_dimension(&self, asked: usize) -> Result<(), FileError> {
        let scene = self.file.dimension;
        if scene.number() == asked {
            Ok(())
        } else {
            Err(self.whole(Problem::OtherWorld { scene, asked }))
        }
    }

    /// Returns an error of the whole scene.
    fn whole(&self, problem: Problem) -> FileError {
        FileError::whole(&self.source.file, problem)
    }
}

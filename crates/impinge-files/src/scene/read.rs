//! Resolves a document to a scene: reads files, expands grids, and checks that names are unique.

use std::collections::BTreeSet;

use impinge::math::na::Vector3;

use super::groups::{DisabledPair, GroupPlan};
use super::pose::{Motion, vector};
use super::{Form, MeshTable, Placement, Scene, SceneObject};
use crate::error::{Fault, Within};
use crate::files::check;
use crate::format::{
    GroupsFile, MeshSource, MeshesFile, ObjectFile, QueryFile, QueryTypeFile, RepeatFile,
    RobotFile, SceneFile, ShapeFile, ShapeRef,
};
use crate::robot::{JointBeyondLimits, RobotLink};
use crate::source::Source;
use crate::{Dimension, FileError, Limit, Problem};

/// An error of resolving a scene: a problem in the document, or an error of a file that it names.
enum ResolveError {
    Document(Fault),
    File(FileError),
}

impl From<FileError> for ResolveError {
    fn from(error: FileError) -> Self {
        Self::File(error)
    }
}

impl From<Fault> for ResolveError {
    fn from(fault: Fault) -> Self {
        Self::Document(fault)
    }
}

/// The objects and files that were collected from the document so far.
struct Collected<'a> {
    file: &'a SceneFile,
    forms: Vec<Form>,
    objects: Vec<Draft<'a>>,
    /// The total number of bytes of the names of the objects.
    names: usize,
    disabled: BTreeSet<DisabledPair>,
    meshes: MeshTable,
    joints_beyond_limits: Vec<JointBeyondLimits>,
}

/// An object without its groups, which are computed after all objects are known.
struct Draft<'a> {
    name: String,
    form: usize,
    start: Placement,
    common: Common<'a>,
}

/// The data that all objects of one entry of the document have in common.
#[derive(Clone, Copy)]
struct Common<'a> {
    groups: &'a GroupsFile,
    query: QueryTypeFile,
    motion: Option<Motion>,
}

impl Scene {
    /// Resolves a parsed document to a scene, which keeps the table of the mesh files that were
    /// read.
    pub(super) fn resolve(
        source: Source,
        file: SceneFile,
        meshes: MeshTable,
    ) -> Result<Self, FileError> {
        let mut collected = Collected::new(&file, meshes);
        let objects = collected.add_all().and_then(|()| Ok(collected.take_objects()?));
        let objects = objects.map_err(|error| match error {
            ResolveError::Document(fault) => source.error(fault),
            ResolveError::File(error) => error,
        })?;
        let Collected { forms, meshes, joints_beyond_limits, .. } = collected;
        Ok(Self { source, file, forms, objects, meshes, joints_beyond_limits })
    }
}

impl<'a> Collected<'a> {
    /// Creates a collection without objects.
    const fn new(file: &'a SceneFile, meshes: MeshTable) -> Self {
        Self {
            file,
            forms: Vec::new(),
            objects: Vec::new(),
            names: 0,
            disabled: BTreeSet::new(),
            meshes,
            joints_beyond_limits: Vec::new(),
        }
    }

    /// Reads all files of the document, and adds all objects in their order.
    fn add_all(&mut self) -> Result<(), ResolveError> {
        let file = self.file;
        file.shapes.values().try_for_each(|shape| self.meshes.read_files(shape))?;
        for (index, object) in file.objects.iter().enumerate() {
            self.add_object(object, format!("objects[{index}]"))?;
        }
        for (index, meshes) in file.meshes.iter().enumerate() {
            self.add_meshes(meshes, format!("meshes[{index}]"))?;
        }
        for (index, robot) in file.robots.iter().enumerate() {
            self.add_robot(robot, &format!("robots[{index}]"))?;
        }
        for query in file.queries.values() {
            if let QueryFile::Cast(cast) = query {
                self.meshes.read_all(&cast.shape)?;
            }
        }
        Ok(())
    }

    fn add_object(&mut self, object: &'a ObjectFile, path: String) -> Result<(), ResolveError> {
        self.meshes.read_all(&object.shape)?;
        let dimension = self.file.dimension;
        let start =
            Placement::read(&object.position, dimension).within("position").within(&path)?;
        let motion = Motion::read(&object.motion, dimension).within("motion").within(&path)?;
        let common = Common { groups: &object.groups, query: object.query, motion };
        let form = self.form(object.shape.clone(), path.clone(), "shape");
        let Some(repeat) = &object.repeat else {
            self.expect(1, object.name.len()).within("name").within(&path)?;
            self.add(object.name.clone(), form, start, common);
            return Ok(());
        };
        let grid = Grid::read(repeat, dimension).within("repeat").within(&path)?;
        let name = object.name.len() + grid.text_len();
        self.expect(grid.len(), grid.len().saturating_mul(name))
            .within("repeat.count")
            .within(&path)?;
        for index in 0..grid.len() {
            let indices = grid.indices(index);
            let name = format!("{}[{}]", object.name, text_of(&indices));
            self.add(name, form, start.translated(grid.offset(&indices)), common);
        }
        Ok(())
    }

    /// Checks the limits before `objects` objects with names of `names` bytes in total are added,
    /// and counts these bytes.
    fn expect(&mut self, objects: usize, names: usize) -> Result<(), Problem> {
        let files = &self.meshes.files;
        let total = self.objects.len().saturating_add(objects);
        check(Limit::Objects, total, files.limits.objects)?;
        let names = self.names.saturating_add(names);
        check(Limit::Names, names, files.allowed(files.limits.names))?;
        self.names = names;
        Ok(())
    }

    fn add_meshes(&mut self, meshes: &'a MeshesFile, path: String) -> Result<(), ResolveError> {
        let dimension = self.file.dimension;
        let start =
            Placement::read(&meshes.position, dimension).within("position").within(&path)?;
        let motion = Motion::read(&meshes.motion, dimension).within("motion").within(&path)?;
        let common = Common { groups: &meshes.groups, query: meshes.query, motion };
        let parts = self.meshes.read(&meshes.path)?.parts().iter();
        let parts = parts.filter(|part| !part.triangles.is_empty());
        let names: Vec<String> = parts.map(|part| part.name.clone()).collect();
        let prefix = meshes.name.as_ref().map_or(0, |name| name.len() + 1);
        for part in names {
            self.expect(1, prefix + part.len()).within(&path)?;
            let source = MeshSource {
                path: meshes.path.clone(),
                part: Some(part.clone()),
                scale: meshes.scale,
                kind: meshes.kind,
            };
            let shape = ShapeRef::Inline(Box::new(ShapeFile::MeshFile(source)));
            let form = self.form(shape, path.clone(), "");
            let name =
                meshes.name.as_ref().map_or_else(|| part.clone(), |name| format!("{name}/{part}"));
            self.add(name, form, start, common);
        }
        Ok(())
    }

    fn add_robot(&mut self, robot: &'a RobotFile, path: &str) -> Result<(), ResolveError> {
        let dimension = self.file.dimension;
        let start = Placement::read(&robot.position, dimension).within("position").within(path)?;
        let Placement::Three(base) = start else {
            let problem = Problem::WrongDimension { what: "a robot", dimension };
            return Err(Fault::from(problem).within(path).into());
        };
        let read = self.meshes.read_robot(robot)?;
        let links = read.links(robot, &base).within(path)?;
        let common = Common { groups: &robot.groups, query: robot.query, motion: None };
        let prefix = robot.name.as_deref().unwrap_or(&read.name);
        let first = self.objects.len();
        let pairs = read.disabled_pairs().into_iter();
        self.disabled.extend(pairs.map(|pair| DisabledPair::new(pair.map(|link| first + link))));
        self.expect(0, read.num_joints().saturating_mul(prefix.len())).within(path)?;
        self.joints_beyond_limits.extend(read.beyond_limits(robot, prefix));
        for RobotLink { name, shape, frame } in links {
            self.expect(1, prefix.len() + 1 + name.len()).within(path)?;
            self.meshes.read_files(&shape)?;
            let form = self.form(ShapeRef::Inline(Box::new(shape)), path.to_owned(), "");
            self.add(format!("{prefix}/{name}"), form, Placement::Three(frame), common);
        }
        Ok(())
    }

    fn form(&mut self, shape: ShapeRef, path: String, member: &'static str) -> usize {
        self.forms.push(Form { shape, path, member });
        self.forms.len() - 1
    }

    fn add(&mut self, name: String, form: usize, start: Placement, common: Common<'a>) {
        self.objects.push(Draft { name, form, start, common });
    }

    /// Moves the objects out of the collection, and computes their groups.
    fn take_objects(&mut self) -> Result<Vec<SceneObject>, Fault> {
        self.check_names()?;
        let drafts = std::mem::take(&mut self.objects);
        let mut plan = GroupPlan::new(self.file);
        let own = plan.separate(drafts.len(), &self.disabled).within("robots")?;
        let objects = drafts.into_iter().zip(&own).map(|(draft, own)| {
            let Draft { name, form, start, common: Common { groups, query, motion } } = draft;
            let groups = plan.groups(groups, own).within("groups");
            let groups = groups.within(&self.forms[form].path)?;
            Ok(SceneObject { name, form, start, motion, groups, query })
        });
        objects.collect()
    }

    /// Checks that no two objects have the same name.
    fn check_names(&self) -> Result<(), Fault> {
        let mut names = BTreeSet::new();
        match self.objects.iter().find(|draft| !names.insert(&draft.name)) {
            None => Ok(()),
            Some(Draft { name, form, .. }) => {
                let problem = Problem::DuplicateName(name.clone());
                Err(problem).within("name").within(&self.forms[*form].path)
            }
        }
    }
}

/// A grid of objects: the count along each axis, and the distance between neighbours.
struct Grid {
    count: Vec<usize>,
    spacing: Vector3<f64>,
}

impl Grid {
    fn read(repeat: &RepeatFile, dimension: Dimension) -> Result<Self, Fault> {
        let spacing = vector(&repeat.spacing, dimension).within("spacing")?;
        let (needed, given) = (dimension.number(), repeat.count.len());
        if needed != given {
            return Err(Problem::WrongLength { needed, given }).within("count");
        }
        if repeat.count.contains(&0) {
            let what = "there must be at least one along each axis";
            return Err(Problem::BadValue { what, value: 0.0 }).within("count");
        }
        Ok(Self { count: repeat.count.clone(), spacing })
    }

    fn len(&self) -> usize {
        self.count.iter().fold(1, |product: usize, count| product.saturating_mul(*count))
    }

    /// Returns an upper bound of the number of bytes of the indices in a name, with their brackets.
    fn text_len(&self) -> usize {
        let digits = |count: &usize| count.to_string().len() + 1;
        self.count.iter().map(digits).sum::<usize>() + 1
    }

    /// Converts the index of an object in the grid to its indices along the axes. The last axis
    /// varies fastest.
    fn indices(&self, index: usize) -> Vec<usize> {
        let mut rest = index;
        let mut indices = vec![0; self.count.len()];
        for (own, count) in indices.iter_mut().zip(&self.count).rev() {
            *own = rest % count;
            rest /= count;
        }
        indices
    }

    /// Returns the offset from the first object of the grid to the object with these indices.
    fn offset(&self, indices: &[usize]) -> Vector3<f64> {
        let mut offset = Vector3::zeros();
        for (axis, index) in indices.iter().enumerate() {
            offset[axis] = self.spacing[axis] * *index as f64;
        }
        offset
    }
}

/// Formats indices as they occur in names, without the brackets, such as `2,0,1`.
fn text_of(indices: &[usize]) -> String {
    indices.iter().map(ToString::to_string).collect::<Vec<_>>().join(",")
}

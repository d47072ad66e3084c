//! From a document to a scene: files are read, grids expanded, names compared.

use std::collections::BTreeSet;
use std::path::Path;

use impinge::math::na::Vector3;

use super::groups::{DisabledPair, GroupPlan};
use super::pose::{Motion, vector};
use super::{Form, MAX_OBJECTS, MeshTable, Placement, Scene, SceneObject};
use crate::error::{Fault, Within};
use crate::format::{
    GroupsFile, MeshSource, MeshesFile, MotionFile, ObjectFile, QueryTypeFile, RepeatFile,
    RobotFile, SceneFile, ShapeFile, ShapeRef,
};
use crate::robot::{Robot, RobotLink};
use crate::source::Source;
use crate::{FileError, Problem};

/// Why a scene cannot be resolved: in the document, or in a file that it names.
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

/// Objects as they are collected.
struct Collected {
    forms: Vec<Form>,
    objects: Vec<Draft>,
    disabled: BTreeSet<DisabledPair>,
    meshes: MeshTable,
}

/// An object without its groups, which depend on those of all.
struct Draft {
    name: String,
    form: usize,
    start: Placement,
    motion: Option<Motion>,
    groups: GroupsFile,
    query: QueryTypeFile,
}

/// What objects have in common that come from one entry of the document.
struct Common<'a> {
    groups: &'a GroupsFile,
    query: &'a QueryTypeFile,
    motion: Option<Motion>,
}

impl Scene {
    /// The scene of a document that was parsed.
    pub(super) fn resolve(
        source: Source,
        file: SceneFile,
        folder: &Path,
    ) -> Result<Self, FileError> {
        match collect(&file, folder) {
            Ok(Collected { forms, objects, disabled, meshes }) => {
                let objects = with_groups(&file, objects, &disabled, &forms);
                let objects = objects.map_err(|fault| source.error(fault))?;
                Ok(Self { source, file, forms, objects, meshes })
            }
            Err(ResolveError::Document(fault)) => Err(source.error(fault)),
            Err(ResolveError::File(error)) => Err(error),
        }
    }
}

fn collect(file: &SceneFile, folder: &Path) -> Result<Collected, ResolveError> {
    let (forms, objects) = (Vec::new(), Vec::new());
    let (disabled, meshes) = (BTreeSet::new(), MeshTable::new(folder));
    let mut collected = Collected { forms, objects, disabled, meshes };
    file.shapes.values().try_for_each(|shape| collected.meshes.read_all(shape))?;
    for (index, object) in file.objects.iter().enumerate() {
        collected.add_object(file, object, format!("objects[{index}]"))?;
    }
    for (index, meshes) in file.meshes.iter().enumerate() {
        collected.add_meshes(file, meshes, format!("meshes[{index}]"))?;
    }
    for (index, robot) in file.robots.iter().enumerate() {
        collected.add_robot(file, robot, &format!("robots[{index}]"), folder)?;
    }
    Ok(collected)
}

impl Collected {
    fn add_object(
        &mut self,
        file: &SceneFile,
        object: &ObjectFile,
        path: String,
    ) -> Result<(), ResolveError> {
        if let Some(shape) = object.shape.inline() {
            self.meshes.read_all(shape)?;
        }
        let dimension = file.dimension;
        let start =
            Placement::read(&object.position, dimension).within("position").within(&path)?;
        let motion = Motion::read(&object.motion, dimension).within("motion").within(&path)?;
        let common = Common { groups: &object.groups, query: &object.query, motion };
        let form = self.form(object.shape.clone(), path.clone(), "shape");
        match &object.repeat {
            None => self.add(object.name.clone(), form, start, &common),
            Some(repeat) => {
                let grid = Grid::read(repeat, file).within("repeat").within(&path)?;
                let room = MAX_OBJECTS.saturating_sub(self.objects.len());
                check_count(grid.len(), room).within("repeat.count").within(&path)?;
                for index in 0..grid.len() {
                    let name = format!("{}[{}]", object.name, grid.indices_text(index));
                    self.add(name, form, start.translated(grid.offset(index)), &common);
                }
            }
        }
        Ok(())
    }

    fn add_meshes(
        &mut self,
        file: &SceneFile,
        meshes: &MeshesFile,
        path: String,
    ) -> Result<(), ResolveError> {
        let dimension = file.dimension;
        let start =
            Placement::read(&meshes.position, dimension).within("position").within(&path)?;
        let motion = Motion::read(&meshes.motion, dimension).within("motion").within(&path)?;
        let common = Common { groups: &meshes.groups, query: &meshes.query, motion };
        let parts = self.meshes.read(&meshes.path)?.parts().iter();
        let parts = parts.filter(|part| !part.triangles.is_empty());
        let names: Vec<String> = parts.map(|part| part.name.clone()).collect();
        for part in names {
            let source = MeshSource {
                path: meshes.path.clone(),
                part: Some(part.clone()),
                scale: meshes.scale.clone(),
                kind: meshes.kind,
            };
            let shape = ShapeRef::Inline(Box::new(ShapeFile::MeshFile(source)));
            let form = self.form(shape, path.clone(), "");
            let name =
                meshes.name.as_ref().map_or_else(|| part.clone(), |name| format!("{name}/{part}"));
            self.add(name, form, start, &common);
        }
        Ok(())
    }

    fn add_robot(
        &mut self,
        file: &SceneFile,
        robot: &RobotFile,
        path: &str,
        folder: &Path,
    ) -> Result<(), ResolveError> {
        let start =
            Placement::read(&robot.position, file.dimension).within("position").within(path)?;
        let Placement::Space(base) = start else {
            let (what, dimension) = ("a robot", file.dimension);
            return Err(Fault::from(Problem::WrongDimension { what, dimension })
                .within(path)
                .into());
        };
        let read = Robot::read(robot, folder)?;
        let links = read.links(robot, &base).within(path)?;
        let common = Common { groups: &robot.groups, query: &robot.query, motion: None };
        let prefix = robot.name.as_deref().unwrap_or(&read.name);
        let first = self.objects.len();
        for RobotLink { name, shape, frame } in links.iter() {
            self.meshes.read_all(shape)?;
            let shape = ShapeRef::Inline(Box::new(shape.clone()));
            let form = self.form(shape, path.to_owned(), "");
            self.add(format!("{prefix}/{name}"), form, Placement::Space(*frame), &common);
        }
        let pairs = read.disabled_pairs(&links);
        self.disabled
            .extend(pairs.into_iter().map(|pair| DisabledPair(pair.map(|link| first + link))));
        Ok(())
    }

    fn form(&mut self, shape: ShapeRef, path: String, member: &'static str) -> usize {
        self.forms.push(Form { shape, path, member });
        self.forms.len() - 1
    }

    fn add(&mut self, name: String, form: usize, start: Placement, common: &Common<'_>) {
        let (groups, query, motion) = (common.groups.clone(), common.query.clone(), common.motion);
        self.objects.push(Draft { name, form, start, motion, groups, query });
    }
}

/// The objects with their groups; no two have the same name.
fn with_groups(
    file: &SceneFile,
    drafts: Vec<Draft>,
    disabled: &BTreeSet<DisabledPair>,
    forms: &[Form],
) -> Result<Vec<SceneObject>, Fault> {
    let mut plan = GroupPlan::new(file);
    let own = plan.separate(drafts.len(), disabled).within("robots")?;
    let mut names = BTreeSet::new();
    for draft in &drafts {
        if !names.insert(draft.name.as_str()) {
            let problem = Problem::DuplicateName(draft.name.clone());
            return Err(Fault::from(problem).within("name").within(&forms[draft.form].path));
        }
    }
    drop(names);
    let objects = drafts.into_iter().zip(&own).map(|(draft, own)| {
        let Draft { name, form, start, motion, groups, query } = draft;
        let groups = plan.groups(&groups, own).within("groups").within(&forms[form].path)?;
        Ok(SceneObject { name, form, start, motion, groups, query })
    });
    objects.collect()
}

/// The places of a grid.
struct Grid {
    count: Vec<usize>,
    spacing: Vector3<f64>,
}

impl Grid {
    fn read(repeat: &RepeatFile, file: &SceneFile) -> Result<Self, Fault> {
        let spacing = vector(&repeat.spacing, file.dimension).within("spacing")?;
        let (needed, given) = (file.dimension.number(), repeat.count.len());
        if needed != given {
            return Err(Fault::from(Problem::WrongLength { needed, given }).within("count"));
        }
        Ok(Self { count: repeat.count.clone(), spacing })
    }

    fn len(&self) -> usize {
        self.count.iter().fold(1, |product: usize, count| product.saturating_mul(*count))
    }

    /// The index along each axis; the last axis runs fastest.
    fn indices(&self, index: usize) -> Vec<usize> {
        let mut rest = index;
        let mut indices = vec![0; self.count.len()];
        for (place, count) in indices.iter_mut().zip(&self.count).rev() {
            *place = rest % count;
            rest /= count;
        }
        indices
    }

    fn indices_text(&self, index: usize) -> String {
        let indices = self.indices(index);
        indices.iter().map(ToString::to_string).collect::<Vec<_>>().join(",")
    }

    fn offset(&self, index: usize) -> Vector3<f64> {
        let mut offset = Vector3::zeros();
        for (axis, place) in self.indices(index).into_iter().enumerate() {
            offset[axis] = self.spacing[axis] * place as f64;
        }
        offset
    }
}

fn check_count(given: usize, limit: usize) -> Result<(), Problem> {
    let what = "objects";
    if given > limit { Err(Problem::TooMany { what, given, limit }) } else { Ok(()) }
}

impl MeshesFile {
    /// The parts of a file as they are, at the origin.
    pub(super) fn new(path: &Path) -> Self {
        Self {
            name: None,
            path: path.to_owned(),
            scale: Default::default(),
            kind: Default::default(),
            position: Default::default(),
            groups: GroupsFile::default(),
            query: QueryTypeFile::default(),
            motion: MotionFile::default(),
        }
    }
}

impl RobotFile {
    /// The robot of a file at the origin, with all joints at 0.
    pub(super) fn new(path: &Path) -> Self {
        Self {
            name: None,
            urdf: path.to_owned(),
            srdf: None,
            packages: Vec::new(),
            joints: Default::default(),
            position: Default::default(),
            kind: Default::default(),
            groups: GroupsFile::default(),
            query: QueryTypeFile::default(),
        }
    }
}

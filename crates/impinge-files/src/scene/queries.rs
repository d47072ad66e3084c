//! The queries of a scene.

use impinge::bounding_volume::Ray;
use impinge::math::Vector;
use impinge::query::ImpactOptions;
use impinge_record::{CastQuestion, PlacedShape, Query, Question, RayQuestion};

use super::pose::not_a_direction;
use super::shapes::coordinates;
use super::{Placement, Scene, SceneSpace};
use crate::FileError;
use crate::error::{Fault, Within};
use crate::format::{CastFile, QueryFile, RayFile};

/// A query of a scene, for [`Query::ask`] and [`Recorder::ask`](impinge_record::Recorder::ask).
#[derive(Clone, Debug)]
pub struct NamedQuery<N: SceneSpace<D>, const D: usize> {
    /// The name in the document.
    pub name: String,
    /// The query.
    pub query: Query<N, D>,
}

impl Scene {
    /// Returns the queries of the document, in order of their names.
    ///
    /// ```
    /// use impinge_files::Scene;
    ///
    /// let text = r#"{"dimension": 2,
    ///     "objects": [{"name": "ball", "shape": {"ball": {"radius": 1}}}],
    ///     "queries": {"down": {"ray": {"origin": [0, 5], "direction": [0, -1]}}}
    /// }"#;
    /// let scene = Scene::from_json("rays.json", text)?;
    /// let mut world = scene.world::<f64, 2>()?;
    /// world.step(0.0)?;
    /// let [down] = &scene.queries::<f64, 2>()?[..] else { panic!("one query") };
    /// assert_eq!((down.name.as_str(), down.query.ask(&world).len()), ("down", 1));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the dimension differs from that of the scene, a direction is zero, coordinates or a
    /// position are invalid, or a shape is unknown or invalid.
    pub fn queries<N: SceneSpace<D>, const D: usize>(
        &self,
    ) -> Result<Vec<NamedQuery<N, D>>, FileError> {
        self.check_dimension(D)?;
        let queries = self.file.queries.iter().map(|(name, query)| {
            let question = match query {
                QueryFile::Ray(ray) => Self::ray(ray).within("ray"),
                QueryFile::Cast(cast) => self.cast(cast).within("cast"),
            };
            let query = Query::new(question.within(name).within("queries")?);
            Ok(NamedQuery { name: name.clone(), query })
        });
        let queries: Result<_, Fault> = queries.collect();
        queries.map_err(|fault| self.source.error(fault))
    }

    fn ray<N: SceneSpace<D>, const D: usize>(ray: &RayFile) -> Result<Question<N, D>, Fault> {
        let origin: Vector<N, D> = coordinates(&ray.origin).within("origin")?;
        let direction: Vector<N, D> = coordinates(&ray.direction).within("direction")?;
        if direction == Vector::<N, D>::zeros() {
            return Err(not_a_direction(0.0)).within("direction");
        }
        let max_time = ray.max_time.map_or(N::INFINITY, N::lit);
        let ray_question =
            RayQuestion { ray: Ray::new(origin.into(), direction), max_time, solid: true };
        Ok(match ray.all {
            true => Question::RayHits(ray_question),
            false => Question::FirstRayHit(ray_question),
        })
    }

    fn cast<N: SceneSpace<D>, const D: usize>(
        &self,
        cast: &CastFile,
    ) -> Result<Question<N, D>, Fault> {
        let shape = self.builder(&self.meshes).make(&cast.shape).within("shape")?;
        let start = Placement::read(&cast.position, self.file.dimension).within("position")?;
        let start = PlacedShape { position: start.isometry::<N, D>()?, shape };
        let velocity = coordinates(&cast.velocity).within("velocity")?;
        let max_time = cast.max_time.map_or(N::INFINITY, N::lit);
        let options = ImpactOptions::new().with_max_time(max_time);
        let question = CastQuestion { start, velocity, options };
        Ok(match cast.all {
            true => Question::CastShapeAll(question),
            false => Question::CastShape(question),
        })
    }
}

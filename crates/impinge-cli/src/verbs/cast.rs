//! `impinge cast`: finds the first hit, or all hits, of a moving shape or object.

use impinge::math::{Pose, Vector};
use impinge::query::ImpactOptions;
use impinge::shape::{Ball, Capsule, Cuboid, ShapeHandle};
use impinge::world::{CollisionWorld, QueryFilter};

use crate::args::{CastArgs, ShapeKind, ShapeSpec, ShortShape};
use crate::convert::{scalar, vector};
use crate::error::CliError;
use crate::hits::{CastHit, Hits};
use crate::number::Number;
use crate::output::{Outcome, finish};
use crate::scene::Loaded;
use crate::space::{Stage, Task, run_in};

/// Runs the verb.
pub(crate) fn run(args: &CastArgs) -> Result<Outcome, CliError> {
    let loaded = Loaded::read(&args.scene)?;
    finish(&run_in(loaded.kind, CastShape { loaded: &loaded, args })?, args.format)
}

/// The task that casts a shape or an object in a scene.
struct CastShape<'a> {
    loaded: &'a Loaded,
    args: &'a CastArgs,
}

/// A shape that moves from `start` by `translation`, and a filter of the objects that it may hit.
struct Sweep<N: Stage<D>, const D: usize> {
    shape: ShapeHandle<N, D>,
    start: N::Isometry,
    translation: Vector<N, D>,
    filter: QueryFilter<'static, N, D, String>,
}

impl Task for CastShape<'_> {
    type Answer = Hits<CastHit>;

    fn run<N: Stage<D>, const D: usize>(self) -> Result<Hits<CastHit>, CliError> {
        let Self { loaded, args } = self;
        let world = loaded.world_without_pairs::<N, D>()?;
        let Sweep { shape, start, translation, filter } = self.sweep(&world)?;
        // The translation is used as the velocity, so the path ends at time 1.
        let options = ImpactOptions::new()
            .with_max_time(N::ONE)
            .with_target_distance(scalar("--distance", args.distance.0)?);
        let mut found = world.cast_shape_all(&start, &translation, &*shape, &options, &filter);
        found.truncate(if args.all { usize::MAX } else { 1 });
        // The shape does not rotate: its position is the translation of its origin.
        let (origin, length) = (N::translation(&start), translation.norm());
        let hits = found.into_iter().map(|(object, impact)| CastHit {
            object: object.data().clone(),
            time: Number::new(impact.toi),
            moved: Number::new(impact.toi * length),
            position: Number::of_vector(&(origin + translation * impact.toi)),
            point: Number::of_point(&impact.world1),
            normal: Number::of_vector(&impact.normal),
            part: impact.part2,
        });
        Ok(Hits { subject: loaded.subject(), hits: hits.collect() })
    }
}

impl CastShape<'_> {
    /// Returns the sweep of the object that `--object` names, or of the shape of `--shape`. The
    /// filter of an object accepts the objects with which its groups interact; the filter of a
    /// shape accepts all objects.
    fn sweep<N: Stage<D>, const D: usize>(
        &self,
        world: &CollisionWorld<N, D, String>,
    ) -> Result<Sweep<N, D>, CliError> {
        let args = self.args;
        if let (Some(name), Some(by)) = (&args.object, &args.by) {
            let object = self.loaded.object(world, name)?;
            let filter = QueryFilter::new().exclude(object.handle());
            return Ok(Sweep {
                shape: object.shape().clone(),
                start: *object.position(),
                translation: vector("--by", by)?,
                filter: filter.groups(*object.collision_groups()),
            });
        }
        let (Some(spec), Some(from), Some(to)) = (&args.shape, &args.from, &args.to) else {
            // The parser of the command line ensures that all three are given if there is no
            // object.
            let reason = "with --from and --to is needed, or --object with --by";
            return Err(CliError::argument("--shape", "SHAPE", reason));
        };
        let start = vector::<N, D>("--from", from)?;
        Ok(Sweep {
            shape: self.shape(spec)?,
            start: N::isometry(&Pose::from_translation(start)),
            translation: vector::<N, D>("--to", to)? - start,
            filter: QueryFilter::new(),
        })
    }

    /// Creates a shape from its short form, from its name in the scene, or from JSON.
    fn shape<N: Stage<D>, const D: usize>(
        &self,
        spec: &ShapeSpec,
    ) -> Result<ShapeHandle<N, D>, CliError> {
        match spec {
            ShapeSpec::Short(short) => made(short),
            ShapeSpec::Scene(text) => Ok(self.loaded.scene().shape(text)?),
        }
    }
}

/// Creates a shape from its short form; an error if it has the wrong number of sizes or an invalid
/// size.
fn made<N: Stage<D>, const D: usize>(short: &ShortShape) -> Result<ShapeHandle<N, D>, CliError> {
    let refused = |reason: String| CliError::argument("--shape", short, reason);
    let sizes = short.sizes.0.iter().map(|size| scalar::<N>("--shape", *size));
    let sizes = sizes.collect::<Result<Vec<_>, _>>()?;
    let made = match (short.kind, sizes.as_slice()) {
        (ShapeKind::Ball, &[radius]) => Ball::try_new(radius).map(ShapeHandle::new),
        (ShapeKind::Cuboid, extents) if extents.len() == D => {
            Cuboid::try_new(Vector::<N, D>::from_column_slice(extents)).map(ShapeHandle::new)
        }
        (ShapeKind::Capsule, &[half_height, radius]) => {
            Capsule::try_new(half_height, radius).map(ShapeHandle::new)
        }
        (kind, _) => return Err(refused(sizes_of::<D>(kind))),
    };
    made.map_err(|error| refused(error.to_string()))
}

/// Returns the error message about the sizes that a kind of shape has.
fn sizes_of<const D: usize>(kind: ShapeKind) -> String {
    match kind {
        ShapeKind::Ball => "a ball has a radius".to_owned(),
        ShapeKind::Cuboid => format!("a box has {D} half extents"),
        ShapeKind::Capsule => "a capsule has half a height and a radius".to_owned(),
    }
}

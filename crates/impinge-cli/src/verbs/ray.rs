//! `impinge ray`: finds the first hit, or all hits, of a ray.

use impinge::math::Point;
use impinge::query::Ray;
use impinge::world::QueryFilter;

use crate::args::RayArgs;
use crate::convert::{direction, vector};
use crate::error::CliError;
use crate::hits::{Hits, RayHit};
use crate::number::Number;
use crate::output::{Outcome, finish};
use crate::scene::Loaded;
use crate::space::{Stage, Task, run_in};

/// Runs the verb.
pub(crate) fn run(args: &RayArgs) -> Result<Outcome, CliError> {
    let loaded = Loaded::read(&args.scene)?;
    finish(&run_in(loaded.kind, CastRay { loaded: &loaded, args })?, args.format)
}

/// The task that casts a ray in a scene.
struct CastRay<'a> {
    loaded: &'a Loaded,
    args: &'a RayArgs,
}

impl Task for CastRay<'_> {
    type Answer = Hits<RayHit>;

    fn run<N: Stage<D>, const D: usize>(self) -> Result<Hits<RayHit>, CliError> {
        let Self { loaded, args } = self;
        let (ray, max_time) = self.ray::<N, D>()?;
        let world = loaded.world_without_pairs::<N, D>()?;
        let mut found = world.ray_hits(&ray, max_time, !args.hollow, &QueryFilter::new());
        found.truncate(if args.all { usize::MAX } else { 1 });
        let speed = ray.dir.norm();
        let hits = found.into_iter().map(|(object, hit)| RayHit {
            object: object.data().clone(),
            time: Number::new(hit.toi),
            length: Number::new(hit.toi * speed),
            point: Number::of_point(&ray.point_at(hit.toi)),
            normal: Number::of_vector(&hit.normal),
            part: hit.part,
        });
        Ok(Hits { subject: loaded.subject(), hits: hits.collect() })
    }
}

impl CastRay<'_> {
    /// Returns the ray and its maximum time: 1 for `--to`, infinite for `--direction`.
    fn ray<N: Stage<D>, const D: usize>(&self) -> Result<(Ray<N, D>, N), CliError> {
        let args = self.args;
        let origin = vector::<N, D>("--from", &args.from)?;
        let (dir, max_time) = match (&args.to, &args.direction) {
            (Some(to), _) => {
                let end = vector::<N, D>("--to", to)?;
                if end == origin {
                    return Err(CliError::argument("--to", to, "is where the ray starts"));
                }
                (end - origin, N::ONE)
            }
            (None, Some(along)) => (direction::<N, D>("--direction", along)?, N::INFINITY),
            // The parser of the command line ensures that one of them is given.
            (None, None) => {
                return Err(CliError::argument("--from", &args.from, "needs --to or --direction"));
            }
        };
        Ok((Ray::new(Point::from(origin), dir), max_time))
    }
}

//! A picture of a user-defined shape: the lens of the guide.

use super::{AMBER, CLAY, RED, SAND, WIDTH, check_svg, options, turned2};
use impinge::debug_render::{DebugDrawing, DebugRender, Drawn, Style};
use impinge::dim2::bounding_volume::Aabb;
use impinge::dim2::prelude::*;
use impinge::dim2::shape::{Geometry, SupportMap};
use impinge_view::SvgPicture;

/// The intersection of two disks of equal radius around `(0, -offset)` and `(0, offset)`.
#[derive(Debug)]
struct Lens {
    radius: f64,
    offset: f64,
}

impl Lens {
    fn tip(&self) -> f64 {
        (self.radius * self.radius - self.offset * self.offset).sqrt()
    }
}

impl SupportMap<f64, 2> for Lens {
    fn core_support(&self, direction: &Vector<f64>) -> Point<f64> {
        let Some(toward) = direction.try_normalize(0.0) else { return Point::origin() };
        if toward.y.abs() * self.radius > self.offset {
            Point::new(0.0, -self.offset.copysign(toward.y)) + toward * self.radius
        } else {
            Point::new(self.tip().copysign(toward.x), 0.0)
        }
    }
}

impl Shape<f64, 2> for Lens {
    fn geometry(&self) -> Geometry<'_, f64> {
        Geometry::support_map(self)
    }

    fn local_aabb(&self) -> Aabb<f64> {
        let extent = Vector::new(self.tip(), self.radius - self.offset);
        Aabb::new(Point::from(-extent), Point::from(extent))
    }
}

#[test]
fn lenses() {
    let mut world = CollisionWorld::<f64, _>::new(0.02);
    let (everybody, contacts) = (CollisionGroups::new(), ContactQuery::default());
    // This lens is eight wide and four high.
    let lens = ShapeHandle::new(Lens { radius: 5.0, offset: 3.0 });
    let box_shape = ShapeHandle::new(Cuboid::new(Vector::new(1.4, 1.0)));
    world.add(Isometry::identity(), lens.clone(), everybody, contacts, CLAY);
    world.add(turned2(6.0, 1.2, 1.2), lens.clone(), everybody, contacts, CLAY);
    world.add(Isometry::translation(-0.6, 2.8), box_shape, everybody, contacts, SAND);
    world.add(
        Isometry::translation(-5.3, -0.6),
        ShapeHandle::new(Ball::new(1.6)),
        everybody,
        contacts,
        SAND,
    );
    world.update();
    assert_eq!(world.contact_manifolds().count(), 3, "a lens, a box and a ball touch the first");
    let mut options = options::<f64>();
    options.contact_point = Some(Style { color: RED, size: 0.2 });
    options.contact_normal = Some(Style { color: AMBER, size: 1.2 });
    options.query_hit = Some(Style { color: RED, size: 0.6 });
    options.mesh.subdivisions = 128;
    let colors: Vec<_> = world.collision_objects().map(|o| (o.handle(), *o.data())).collect();
    let color_of = move |handle| colors.iter().find(|(own, _)| *own == handle).map(|(_, c)| *c);
    let mut drawing = DebugDrawing::new(options).with_object_color(color_of);
    let mut picture = SvgPicture::plane(WIDTH).with_title(
        "A shape of one's own",
        "Two lenses, known to the library by their support points alone, in contact with a box, a ball and each other, and hit by a ray.",
    );
    drawing.world(&world, &mut picture);
    let ray = Ray::new(Point::new(-7.0, -3.0), Vector::new(1.0, 0.22));
    let (object, hit) =
        world.first_ray_hit(&ray, 20.0, true, &QueryFilter::new()).expect("it hits");
    assert_eq!(*object.data(), CLAY, "a lens");
    drawing.ray(&ray, f64::INFINITY, &[hit], &mut picture);
    picture.text(&(ray.origin + Vector::new(0.0, 0.4)), "a ray", super::BLUE, Drawn::Query);
    check_svg("lens", &picture);
}

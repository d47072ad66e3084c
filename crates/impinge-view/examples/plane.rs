//! Draws the contact of a ball with a floor in 2D and writes it as an SVG. The argument is the path
//! of the file; without it a temporary file is written.

#![allow(clippy::print_stdout, reason = "printing is what the program is for")]

use impinge::debug_render::{Color, DebugRender, Drawn, ShapeMesh};
use impinge::dim2::prelude::*;
use impinge_view::SvgPicture;
use std::path::PathBuf;
use std::{env, fs, io};

/// Returns the mesh of a convex polygon, with its sides as lines.
fn polygon(id: u64, vertices: Vec<Point<f64>>) -> ShapeMesh<f64, 2> {
    let count = u32::try_from(vertices.len()).expect("a few corners");
    ShapeMesh {
        id,
        vertices,
        lines: (0..count).map(|index| [index, (index + 1) % count]).collect(),
        triangles: (2..count).map(|index| [0, index - 1, index]).collect(),
    }
}

/// Returns the corners of a regular polygon with 3 * 2^`doublings` corners on a circle. Each
/// doubling adds the normalized sum of two adjacent corners, which is halfway between them.
fn circle(radius: f64, doublings: u32) -> Vec<Point<f64>> {
    let root = 0.75_f64.sqrt();
    let mut corners =
        vec![Vector::new(1.0, 0.0), Vector::new(-0.5, root), Vector::new(-0.5, -root)];
    for _ in 0..doublings {
        let next = corners.iter().cycle().skip(1);
        let pairs = corners.iter().zip(next);
        corners = pairs.flat_map(|(a, b)| [*a, (a + b).normalize()]).collect();
    }
    corners.into_iter().map(|corner| Point::from(corner * radius)).collect()
}

fn main() -> io::Result<()> {
    let mut world = CollisionWorld::new(0.02_f64);
    let (everybody, contacts) = (CollisionGroups::new(), GeometricQueryType::Contacts(0.0, 0.0));
    let (place, above) = (Isometry::identity(), Isometry::translation(0.5, 1.25));
    let shapes =
        [ShapeHandle::new(Cuboid::new(Vector::new(3.0, 0.5))), ShapeHandle::new(Ball::new(1.0))];
    for (shape, place) in shapes.into_iter().zip([place, above]) {
        world.add(place, shape, everybody, contacts, ());
    }
    world.update();

    let mut picture = SvgPicture::plane(480)
        .with_title("A ball in a floor", "The ball of radius 1 is 0.25 deep in the floor.");
    let corners = [[-3.0, -0.5], [3.0, -0.5], [3.0, 0.5], [-3.0, 0.5]].map(Point::from);
    let floor = polygon(1, corners.to_vec());
    picture.mesh(&floor, &place, Color::rgb(176, 148, 104), Drawn::Object);
    let ball = polygon(2, circle(1.0, 5));
    picture.mesh(&ball, &above, Color::rgb(188, 96, 74), Drawn::Object);
    let red = Color::rgb(196, 54, 60);
    for (_, _, manifold) in world.contact_manifolds() {
        let contact = &manifold.deepest_contact().expect("not empty").contact;
        picture.arrow(
            &contact.world1,
            &(contact.world1 + *contact.normal),
            red,
            Drawn::ContactNormal,
        );
        for point in [contact.world1, contact.world2] {
            picture.point(&point, 0.06, red, Drawn::ContactPoint);
        }
        let depth = format!("depth {}", contact.depth);
        picture.text(&contact.world2, &depth, red, Drawn::ContactPoint);
    }
    let svg = picture.to_svg();
    assert_eq!(svg.matches("<circle").count(), 2, "a point on each surface");
    assert!(svg.contains(">depth 0.25</text>"), "and how deep it is");

    let temporary = || env::temp_dir().join("impinge-plane.svg");
    let path = env::args_os().nth(1).map_or_else(temporary, PathBuf::from);
    fs::write(&path, svg)?;
    println!("{}", path.display());
    Ok(())
}

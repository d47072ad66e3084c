//! Tests that invalid input does not panic, and that the same input gives the same bytes.

use crate::scenes::{INK, box_mesh, boxes, glass, hills, plane};
use impinge::debug_render::{DebugRender, Drawn};
use impinge::dim3::math::{Isometry, Point, Translation, Vector};
use impinge::math::Real;
use impinge_view::{Camera, PngPicture, SvgPicture};

fn oblique() -> Camera {
    Camera::look_along(&Vector::new(-0.6, -0.5, -1.0), &Vector::y())
}

#[test]
fn an_empty_picture_is_its_background() {
    for camera in [Camera::plane(), oblique().perspective(0.7)] {
        let image = PngPicture::new(camera.clone(), [0, 20]).to_image();
        assert_eq!(image.size(), [1, 20], "clamped");
        assert!(image.pixels().iter().all(|pixel| *pixel == image.pixel(0, 0)), "nothing drawn");
        let svg = SvgPicture::space(camera, 0).to_svg();
        assert!(svg.contains("<desc") && svg.contains("Nothing is drawn."), "{svg}");
    }
}

fn bad_numbers<N: Real>(picture: &mut impl DebugRender<N, 3>) -> u64 {
    let bad = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e30, -1e30].map(N::lit);
    let zero = Point::<N>::origin();
    for x in bad {
        let at = Point::new(N::ONE, x, N::ZERO);
        picture.line([zero, at], INK, Drawn::Query);
        picture.point(&at, N::ONE, INK, Drawn::ContactPoint);
        picture.text(&at, "nowhere", INK, Drawn::Object);
        picture.triangle([zero, at, zero], INK, Drawn::Object);
        let nowhere = Isometry::translation(x, N::ZERO, N::ZERO);
        picture.mesh(&box_mesh::<N>(1, [0.5; 3]), &nowhere, INK, Drawn::Object);
        picture.point(&zero, x * if x > N::ZERO { N::ONE } else { -x }, INK, Drawn::Object);
    }
    let mut broken = box_mesh::<N>(2, [0.5; 3]);
    broken.vertices[0].x = N::lit(f64::NAN);
    broken.lines.push([1, 8]);
    picture.mesh(&broken, &Isometry::identity(), INK, Drawn::Object);
    let at_corner = broken.triangles.iter().filter(|corners| corners.contains(&0)).count() as u64;
    // The last terms: three edges meet at the corner, and one line has an index without a vertex.
    5 * 6 + at_corner + 3 + 1
}

fn leaves_out<N: Real>() {
    let mut png = PngPicture::new(oblique(), [60, 40]);
    let expected = bad_numbers::<N>(&mut png);
    assert_eq!(png.left_out(), expected, "of PNG");
    let image = png.to_image();
    assert!(image.pixels().iter().any(|pixel| *pixel != image.pixel(0, 0)), "the rest is there");
    let mut svg = SvgPicture::space(oblique(), 100);
    bad_numbers::<N>(&mut svg);
    assert_eq!(svg.left_out(), expected, "of SVG");
    let text = svg.to_svg();
    assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
    assert!(text.contains(&format!("{expected} of the things drawn")), "mentioned");
    png.clear();
    assert_eq!(png.left_out(), 0, "forgotten");
}

#[test]
fn bad_coordinates_are_left_out_and_counted() {
    leaves_out::<f32>();
    leaves_out::<f64>();
}

#[test]
fn large_and_small_scenes_are_framed() {
    for size in [1e-9, 1e-3, 1.0, 1e6, 1e12] {
        for camera in [oblique(), oblique().perspective(0.7)] {
            let mut picture = PngPicture::new(camera, [60, 40]);
            let mesh = box_mesh::<f64>(1, [size; 3]);
            picture.mesh(&mesh, &Isometry::identity(), INK, Drawn::Object);
            let image = picture.to_image();
            let is_drawn = |pixel: &&[u8; 4]| **pixel != image.pixel(0, 0);
            let drawn = image.pixels().iter().filter(is_drawn).count();
            assert!((700..1400).contains(&drawn), "{drawn} pixels at size {size}");
        }
    }
}

/// Returns the bytes of pictures of all scenes, in PNG and most of them also in SVG.
fn bytes<N: Real>() -> Vec<Vec<u8>> {
    let png = |draw: fn(&mut PngPicture), camera: Camera| {
        let mut picture = PngPicture::new(camera, [80, 60]);
        draw(&mut picture);
        picture.to_png()
    };
    let svg = |draw: fn(&mut SvgPicture), mut picture: SvgPicture| {
        draw(&mut picture);
        picture.to_svg().into_bytes()
    };
    let tilted = oblique().perspective(0.6);
    vec![
        png(boxes::<N>, oblique()),
        png(glass::<N>, tilted.clone()),
        png(hills::<N>, tilted.clone()),
        png(plane::<N>, Camera::plane()),
        svg(boxes::<N>, SvgPicture::space(oblique(), 300)),
        svg(hills::<N>, SvgPicture::space(tilted, 300)),
        svg(plane::<N>, SvgPicture::plane(300)),
    ]
}

#[test]
fn the_same_drawing_gives_the_same_bytes() {
    assert_eq!(bytes::<f32>(), bytes::<f32>(), "f32");
    assert_eq!(bytes::<f64>(), bytes::<f64>(), "f64");
}

#[test]
fn both_scalars_give_the_same_picture_of_the_same_numbers() {
    fn draw<N: Real>() -> Vec<u8> {
        let mut picture = PngPicture::new(oblique(), [80, 60]);
        let place = Translation::from([1.5, -0.25, 0.5].map(N::lit));
        let place = Isometry::from_parts(place, Isometry::identity().rotation);
        picture.mesh(&box_mesh::<N>(1, [0.5, 1.0, 2.0]), &Isometry::identity(), INK, Drawn::Object);
        picture.mesh(&box_mesh::<N>(2, [1.0; 3]), &place, INK.with_alpha(99), Drawn::Object);
        picture.to_png()
    }
    assert_eq!(draw::<f32>(), draw::<f64>(), "numbers that both scalars have");
}

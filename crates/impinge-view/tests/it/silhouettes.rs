//! Compares the pixels that pictures cover, and their colours, with computed values.

use crate::scenes::{INK, ball_mesh, box_mesh, faces};
use impinge::debug_render::{Color, DebugRender, Drawn, ShapeMesh};
use impinge::dim3::math::{Isometry, Point, Vector};
use impinge::math::Real;
use impinge_view::{Camera, Image, PngPicture};

const BLANK: [u8; 4] = [250, 249, 246, 255];

/// Returns the centres of all pixels that are not background.
fn covered(image: &Image) -> Vec<[f64; 2]> {
    let pixels = (0..image.size()[1]).flat_map(|y| (0..image.size()[0]).map(move |x| (x, y)));
    let covered = pixels.filter(|(x, y)| image.pixel(*x, *y) != BLANK);
    covered.map(|(x, y)| [f64::from(x) + 0.5, f64::from(y) + 0.5]).collect()
}

fn assert_is_square(image: &Image, from: f64, to: f64) {
    let found = covered(image);
    let is_inside = |pixel: &[f64; 2]| pixel.iter().all(|x| *x > from && *x < to);
    assert!(found.iter().all(is_inside), "between {from} and {to}");
    assert_eq!(found.len() as f64, (to - from) * (to - from), "every pixel there");
}

fn unit_box<N: Real>() {
    for axis in 0..6 {
        let mut direction = Vector::zeros();
        direction[axis % 3] = if axis < 3 { 1.0 } else { -1.0 };
        let camera = Camera::look_along(&direction, &Vector::new(0.1, 1.0, 0.2));
        let camera = if axis % 3 == 2 { Camera::plane() } else { camera };
        let mut picture = PngPicture::new(camera.clone(), [100, 100]).with_margin(10.0);
        faces(&mut picture, &box_mesh::<N>(1, [0.5; 3]), INK);
        if axis % 3 == 2 {
            assert_is_square(&picture.to_image(), 10.0, 90.0);
            let corners = [Point::new(-2.0, -2.0, -2.0), Point::new(2.0, 2.0, 2.0)];
            picture.set_camera(camera.fit(corners));
            assert_is_square(&picture.to_image(), 40.0, 60.0);
        }
        assert!(covered(&picture.to_image()).len() >= 400, "seen along {direction}");
    }
}

#[test]
fn a_unit_box_covers_the_pixels_of_its_square() {
    unit_box::<f32>();
    unit_box::<f64>();
}

#[test]
fn lines_lie_half_their_width_outside() {
    let mut picture = PngPicture::new(Camera::plane(), [100, 100]).with_margin(10.0);
    picture.mesh(&box_mesh::<f32>(1, [0.5; 3]), &Isometry::identity(), INK, Drawn::Object);
    let image = picture.to_image();
    assert!(covered(&image).iter().all(|pixel| pixel.iter().all(|x| *x > 9.0 && *x < 91.0)));
    let (edge, face) = (image.pixel(10, 50), image.pixel(50, 50));
    assert!(edge[0] < face[0] && edge[1] < face[1] && edge[2] < face[2], "{edge:?}, {face:?}");
}

fn square<N: Real>(picture: &mut PngPicture, half: f64, z: f64, color: Color) {
    let at = |x: f64, y: f64| Point::from([x * half, y * half, z].map(N::lit));
    let [a, b, c, d] = [at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)];
    picture.triangle([a, b, c], color, Drawn::Object);
    picture.triangle([a, c, d], color, Drawn::Object);
}

fn two_squares(camera: Camera, colors: [Color; 2], is_reversed: bool) -> Image {
    let mut picture = PngPicture::new(camera, [40, 40]).with_margin(4.0);
    let mut squares = [(1.0, 0.0, colors[0]), (0.5, 1.0, colors[1])];
    if is_reversed {
        squares.reverse();
    }
    for (half, z, color) in squares {
        square::<f32>(&mut picture, half, z, color);
    }
    picture.to_image()
}

#[test]
fn the_nearer_hides_the_farther() {
    let (red, blue) = (Color::rgb(200, 0, 0), Color::rgb(0, 0, 200));
    let behind = Camera::look_along(&Vector::z(), &Vector::y());
    for is_reversed in [false, true] {
        let image = two_squares(Camera::plane(), [red, blue], is_reversed);
        let [r, _, b, _] = image.pixel(20, 20);
        assert!(r == 0 && b > 100, "the small one is nearer");
        assert!(image.pixel(6, 6)[0] > 100, "the large one is around it");
        let image = two_squares(behind.clone(), [red, blue], is_reversed);
        assert!(image.pixel(20, 20)[2] == 0, "from behind the large one is all there is");
    }
}

#[test]
fn transparent_colours_blend_whatever_the_order() {
    let (red, blue) = (Color::rgb(200, 40, 40), Color::rgb(40, 40, 200));
    let opaque =
        [[red, red], [blue, blue]].map(|colors| two_squares(Camera::plane(), colors, false));
    let glass = [red.with_alpha(128), blue.with_alpha(64)];
    let image = two_squares(Camera::plane(), glass, false);
    assert_eq!(image, two_squares(Camera::plane(), glass, true), "drawn in the other order");
    let mixed = |above: u8, below: u8, alpha: u32| {
        let sum = u32::from(above) * alpha + u32::from(below) * (255 - alpha);
        u8::try_from((sum + 127) / 255).expect("a mean")
    };
    let [red, blue] = opaque.map(|image| image.pixel(20, 20));
    for channel in 0..3 {
        let far = mixed(red[channel], BLANK[channel], 128);
        assert_eq!(image.pixel(6, 6)[channel], far, "the large one on the background");
        let both = mixed(blue[channel], far, 64);
        assert_eq!(image.pixel(20, 20)[channel], both, "the small one on the large one");
    }
}

#[test]
fn the_outline_of_a_ball_is_a_circle() {
    for camera in [Camera::plane(), Camera::look_along(&Vector::new(1.0, -2.0, 3.0), &Vector::y())]
    {
        let corners = [Point::new(-1.0, -1.0, -1.0), Point::new(1.0, 1.0, 1.0)];
        let mut picture = PngPicture::new(camera.clone(), [120, 120]).with_margin(10.0);
        let ball = ball_mesh::<f64>(1, 1.0);
        faces(&mut picture, &ball, INK);
        let image = picture.to_image();
        let distance = |[x, y]: [f64; 2]| ((x - 60.0).powi(2) + (y - 60.0).powi(2)).sqrt();
        let found = covered(&image);
        assert!(found.iter().all(|pixel| distance(*pixel) < 51.0), "nothing outside");
        let all = (0..120 * 120).map(|i| [f64::from(i % 120) + 0.5, f64::from(i / 120) + 0.5]);
        let inside = all.filter(|pixel| distance(*pixel) < 49.0).count();
        assert!(found.len() >= inside, "{} pixels of at least {inside}", found.len());
        assert!(image.pixel(35, 35)[0] > image.pixel(85, 85)[0], "light from the upper left");
        picture.set_camera(camera.fit(corners));
        assert!(covered(&picture.to_image()).len() <= found.len(), "the box holds the ball");
    }
}

#[test]
fn meshes_are_kept_by_their_id() {
    let place = Isometry::translation(2.0, 0.5, 0.0);
    let mesh = box_mesh::<f32>(7, [0.5; 3]);
    let draw = |second: &ShapeMesh<f32, 3>| {
        let mut picture = PngPicture::new(Camera::plane(), [60, 40]);
        picture.mesh(&mesh, &Isometry::identity(), INK, Drawn::Object);
        picture.mesh(second, &place, INK, Drawn::Object);
        picture.to_image()
    };
    let only_id = ShapeMesh { id: 7, ..ShapeMesh::default() };
    assert_eq!(draw(&mesh), draw(&only_id), "the second is the first again");
    assert_ne!(draw(&mesh), draw(&box_mesh(8, [0.3; 3])), "another id");
}

#[test]
fn contacts_show_through_what_hides_them() {
    let draw = |what| {
        let mut picture = PngPicture::new(Camera::plane(), [40, 40]).with_margin(4.0);
        square::<f32>(&mut picture, 1.0, 0.0, INK);
        picture.point(&Point::new(0.0, 0.0, -1.0), 0.5, Color::rgb(255, 0, 0), what);
        picture.to_image().pixel(20, 20)
    };
    let (hidden, through) = (draw(Drawn::Object), draw(Drawn::ContactPoint));
    assert!(through[0] > hidden[0] && through[2] < hidden[2], "{through:?} of {hidden:?}");
}

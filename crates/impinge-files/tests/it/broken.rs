//! Tests truncated files and files with random bytes: each gives a typed error or a valid mesh,
//! never a panic, and no more memory than the size of the file allows.

use std::fs;
use std::path::Path;

use impinge_files::{FileError, MeshFile, Problem, Scene, load};

use crate::cube::samples;

/// A random number generator with a fixed sequence for each seed (Marsaglia, *Xorshift RNGs*,
/// 2003).
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        usize::try_from(self.0 % limit as u64).expect("below a limit that fits")
    }

    fn byte(&mut self) -> u8 {
        self.below(usize::MAX).to_le_bytes()[2]
    }
}

/// Checks the result of reading arbitrary bytes. An error must contain the path. A part must have
/// at most as many vertices, and as many triangles, as the file has bytes, with finite vertices and
/// with corners in range.
fn check(path: &Path, bytes: &[u8]) -> Result<MeshFile, FileError> {
    let read = MeshFile::parse(path, bytes);
    match &read {
        Err(error) => assert_eq!(error.file, path, "{error}"),
        Ok(file) => {
            for part in file.parts() {
                let (vertices, triangles) = (part.vertices.len(), part.triangles.len());
                assert!(vertices <= bytes.len() && triangles <= bytes.len(), "{}", part.report);
                let corners = part.triangles.iter().flatten();
                assert!(
                    corners.into_iter().all(|corner| (*corner as usize) < vertices),
                    "in range"
                );
                assert!(part.vertices.iter().flatten().all(|x| x.is_finite()), "finite");
            }
        }
    }
    read
}

#[test]
fn files_cut_at_every_length() {
    for sample in samples() {
        let mut refused = 0;
        for length in 0..sample.bytes.len() {
            refused += usize::from(check(&sample.path(), &sample.bytes[..length]).is_err());
        }
        // The last lines of a text may be missing without an error.
        assert!(refused > sample.bytes.len() / 4, "{}: {refused} refused", sample.name);
    }
}

#[test]
fn files_with_changed_bytes() {
    let mut numbers = Numbers(88_172_645_463_325_252);
    let (mut refused, mut read) = (0, 0);
    for sample in samples() {
        for _ in 0..1500 {
            let mut bytes = sample.bytes.clone();
            for _ in 0..=numbers.below(4) {
                let at = numbers.below(bytes.len());
                let text = b"-0 9e.\n/\"{[";
                bytes[at] = match numbers.below(2) {
                    0 => text[numbers.below(text.len())],
                    _ => numbers.byte(),
                };
            }
            match check(&sample.path(), &bytes) {
                Ok(_) => read += 1,
                Err(_) => refused += 1,
            }
        }
    }
    assert!(refused > 1000 && read > 1000, "both happen: {refused} refused, {read} read");
}

#[test]
fn bytes_of_no_format() {
    let mut numbers = Numbers(362_436_069);
    for round in 0..400 {
        let length = numbers.below(400);
        let bytes: Vec<u8> = (0..length).map(|_| numbers.byte()).collect();
        for name in ["a.obj", "a.stl", "a.ply", "a.gltf", "a.glb"] {
            assert!(check(name.as_ref(), &bytes).is_err(), "round {round}, {name}");
        }
    }
}

#[test]
fn counts_beyond_the_file_cost_no_memory() {
    let mut stl = crate::cube::stl_binary(b"x");
    stl[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    assert!(check("many.stl".as_ref(), &stl).is_err(), "the triangles end early");
    let ply = "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nend_header\n";
    let error = check("many.ply".as_ref(), ply.as_bytes()).expect_err("no such file");
    assert!(matches!(*error.problem, Problem::TooMany { given: 4_000_000_000, .. }), "{error}");
    let gltf = crate::cube::gltf_text().replace("\"count\": 8", "\"count\": 400000000");
    assert!(check("many.gltf".as_ref(), gltf.as_bytes()).is_err(), "beyond the buffer");
    let strided = crate::cube::gltf_text()
        .replace("\"byteLength\": 96", "\"byteLength\": 96, \"byteStride\": 4");
    assert!(check("strided.gltf".as_ref(), strided.as_bytes()).is_err(), "vertices overlap");
    let typed = crate::cube::gltf_text().replace("5126", "5125");
    assert!(check("typed.gltf".as_ref(), typed.as_bytes()).is_err(), "positions are floats");
}

#[test]
fn sparse_accessors_out_of_order() {
    let sparse = crate::cube::gltf_sparse();
    let cases = [
        ("\"byteLength\": 7}", "\"byteLength\": 6}", "reaches beyond its buffer"),
        (
            "\"byteOffset\": 168, \"byteLength\": 7",
            "\"byteOffset\": 170, \"byteLength\": 7",
            "out of order",
        ),
        ("\"count\": 7", "\"count\": 0", "is empty"),
        ("\"count\": 8", "\"count\": 7", "out of order"),
        ("\"count\": 8", "\"count\": 400000000", "`Limits::elements` raises the limit"),
        (
            "\"bufferView\": 0, \"byteOffset\": 12",
            "\"bufferView\": 0, \"byteOffset\": 13",
            "reaches beyond",
        ),
    ];
    for (whole, broken, message) in cases {
        let text = sparse.replacen(whole, broken, 1);
        assert_ne!(text, sparse, "{whole} is in it");
        let error = check("sparse.gltf".as_ref(), text.as_bytes()).expect_err(broken);
        assert!(error.to_string().contains(message), "{broken}: {error}");
    }
}

#[test]
fn nodes_that_hold_themselves() {
    let looped = crate::cube::gltf_text().replace("\"mesh\": 0", "\"mesh\": 0, \"children\": [0]");
    let error = check("loop.gltf".as_ref(), looped.as_bytes()).expect_err("no tree");
    assert!(error.to_string().contains("two parents"), "{error}");
}

#[test]
fn scene_files_cut_at_every_length() {
    let text = include_str!("../../scenes/gallery2.json");
    let end = text.trim_end().len();
    for length in 0..end {
        let error = Scene::from_json("cut.json", &text[..length]).expect_err("it ends early");
        let lines = text[..length].matches('\n').count() + 1;
        assert!(error.line.is_some_and(|line| line <= lines), "{error}: of {lines}");
        assert!(!error.path.contains('?'), "{error}");
    }
    assert!(Scene::from_json("whole.json", &text[..end]).is_ok(), "nothing is missing");
}

#[test]
fn robots_cut_at_every_length() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("arm.urdf");
    let text = include_str!("../../scenes/arm.urdf");
    for length in 0..text.trim_end().len() {
        fs::write(&path, &text[..length]).expect("it is written");
        let error = load(&path).expect_err("it ends early");
        assert_eq!(error.file, path, "{error}");
    }
}

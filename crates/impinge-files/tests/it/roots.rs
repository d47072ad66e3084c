//! Tests from which folders files may be read.

use std::fs;
use std::path::Path;

use impinge_files::{FileError, Limits, MeshFile, Problem, ReadOptions, Scene, load, load_with};
use tempfile::TempDir;

use crate::cube::{gltf_buffer, gltf_with_uri, obj};

/// Creates a folder `in` with a package, and a folder `out` whose files must not be read.
fn desk() -> TempDir {
    let desk = tempfile::tempdir().expect("a folder");
    let write = |name: &str, bytes: &[u8]| {
        let path = desk.path().join(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("it is made");
        fs::write(path, bytes).expect("it is written");
    };
    for folder in ["out", "in", "in/deep", "in/pack/meshes"] {
        write(&format!("{folder}/cube.bin"), &gltf_buffer());
        write(&format!("{folder}/cube.obj"), obj().as_bytes());
    }
    desk
}

fn is_outside<T>(found: &Result<T, FileError>) -> bool {
    matches!(found, Err(error) if matches!(*error.problem, Problem::Outside { .. }))
}

/// Reads a glTF file in the folder `in`, whose buffer has this URI.
fn gltf(desk: &Path, uri: &str, options: &ReadOptions) -> Result<MeshFile, FileError> {
    let path = desk.join("in/cube.gltf");
    fs::write(&path, gltf_with_uri(uri)).expect("it is written");
    MeshFile::read_with(&path, options)
}

#[test]
fn buffers_are_read_from_the_folder_of_their_file() {
    let desk = desk();
    let desk = desk.path();
    let absolute = |name: &str| desk.join(name).to_str().expect("text").to_owned();
    let read = |uri: &str| gltf(desk, uri, &ReadOptions::new());
    for uri in
        ["cube.bin", "deep/cube.bin", "deep/../cube.bin", "%63ube.bin", &absolute("in/cube.bin")]
    {
        assert!(read(uri).is_ok(), "{uri}: {:?}", read(uri));
    }
    let out = absolute("out/cube.bin");
    for uri in [
        "../out/cube.bin",
        "%2e%2e/out/cube.bin",
        "..%2Fout%2fcube.bin",
        "deep/../../out/cube.bin",
        &out,
        &format!("file://{out}"),
        "/dev/zero",
        "../out/nothing.bin",
        "/nothing/at/all",
    ] {
        assert!(is_outside(&read(uri)), "{uri}: {:?}", read(uri));
        let error = read(uri).expect_err("outside").to_string();
        assert!(error.contains("the root from which files are read"), "{error}");
    }
    let root = ReadOptions::new().with_root(desk);
    assert!(gltf(desk, "../out/cube.bin", &root).is_ok(), "a root may be given");
    assert!(is_outside(&gltf(desk, "../../cube.bin", &root)), "and is one");
    for uri in ["http://example.org/cube.bin", "nothing.bin", "deep"] {
        assert!(read(uri).is_err() && !is_outside(&read(uri)), "{uri}");
    }
}

#[cfg(unix)]
#[test]
fn links_pipes_and_devices() {
    let desk = desk();
    let desk = desk.path();
    let link = |to: &str, name: &str| {
        std::os::unix::fs::symlink(to, desk.join("in").join(name)).expect("a link");
    };
    link("../out/cube.bin", "out.bin");
    link("../out", "away");
    link("/dev/zero", "zero.bin");
    link("deep/cube.bin", "own.bin");
    let read = |uri: &str| gltf(desk, uri, &ReadOptions::new());
    for uri in ["out.bin", "away/cube.bin", "zero.bin"] {
        assert!(is_outside(&read(uri)), "{uri}: {:?}", read(uri));
    }
    assert!(read("own.bin").is_ok(), "within the folder");
    // A folder may be named through a symbolic link.
    std::os::unix::fs::symlink(desk.join("in"), desk.join("linked")).expect("a link");
    assert!(MeshFile::read(&desk.join("linked/cube.gltf")).is_ok());
    let pipe = desk.join("in/pipe.obj");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().expect("it runs").success());
    for path in [pipe.as_path(), &desk.join("in/deep/../pipe.obj")] {
        let error = load(path).expect_err("nobody would ever write");
        assert_eq!(*error.problem, Problem::NotAFile, "{error}");
    }
    let any = ReadOptions::new().with_root("/");
    let error = gltf(desk, "/dev/zero", &any).expect_err("it has no end");
    assert_eq!(*error.problem, Problem::NotAFile, "{error}");
}

#[test]
fn files_of_scenes_are_read_from_their_folder() {
    let desk = desk();
    let path = desk.path().join("in/scene.json");
    let read = |member: &str| Scene::from_json(&path, &format!("{{\"dimension\": 3, {member}}}"));
    let out = desk.path().join("out/cube.obj");
    let shape = |path: &str| format!("{{\"mesh_file\": {{\"path\": {path:?}}}}}");
    fs::write(desk.path().join("out/arm.urdf"), "<robot name=\"r\"><link name=\"a\"/></robot>")
        .expect("it is written");
    for bad in ["../out/cube.obj", out.to_str().expect("text")] {
        for member in [
            format!("\"meshes\": [{{\"path\": {bad:?}}}]"),
            format!("\"objects\": [{{\"name\": \"a\", \"shape\": {}}}]", shape(bad)),
            format!("\"shapes\": {{\"a\": {}}}", shape(bad)),
            format!(
                "\"queries\": {{\"a\": {{\"cast\": {{\"shape\": {}, \"velocity\": [1, 0, 0]}}}}}}",
                shape(bad)
            ),
            "\"robots\": [{\"urdf\": \"../out/arm.urdf\"}]".to_owned(),
        ] {
            assert!(is_outside(&read(&member)), "{member}: {:?}", read(&member).err());
        }
    }
    let scene = read(
        "\"meshes\": [{\"path\": \"deep/cube.obj\"}, {\"path\": \"deep/../deep/cube.obj\", \"name\": \"b\"}]",
    );
    let scene = scene.expect("within");
    assert_eq!((scene.names().len(), scene.mesh_files().count()), (2, 1), "one file by two names");
    let query = scene.shape::<f64, 3>(&shape("../out/cube.obj"));
    assert!(is_outside(&query), "a shape that is asked for later");
}

fn urdf(mesh: &str) -> String {
    format!(
        "<robot name=\"r\"><link name=\"a\"><collision><geometry><mesh filename=\"{mesh}\"/></geometry></collision></link></robot>"
    )
}

#[test]
fn packages_of_robots() {
    let desk = desk();
    let desk = desk.path();
    fs::create_dir(desk.join("in/pack/urdf")).expect("it is made");
    let path = desk.join("in/pack/urdf/arm.urdf");
    let read = |mesh: &str, options: &ReadOptions| {
        fs::write(&path, urdf(mesh)).expect("it is written");
        load_with(&path, options)
    };
    let plain = ReadOptions::new();
    let mesh = "package://pack/meshes/cube.obj";
    let error = read(mesh, &plain).expect_err("not in the folder of the file");
    assert_eq!(*error.problem, Problem::UnknownPackage("pack".to_owned()), "{error}");
    let root = ReadOptions::new().with_root(desk.join("in"));
    assert!(read(mesh, &root).is_ok(), "in a root that is given: {:?}", read(mesh, &root).err());
    assert!(read("package://in/deep/cube.obj", &root).is_ok(), "the root is a package by its name");
    let packages = ReadOptions::new().with_packages(desk.join("in"));
    assert!(read(mesh, &packages).is_ok(), "in a folder of packages");
    // A folder is a package if it has a manifest.
    fs::write(desk.join("in/pack/package.xml"), "<package/>").expect("it is written");
    assert!(read(mesh, &plain).is_ok() && read("../meshes/cube.obj", &plain).is_ok());
    let out = desk.join("out/cube.obj");
    for mesh in [
        "package://pack/../../out/cube.obj",
        "package://pack/meshes/../../deep/cube.obj",
        "../../../out/cube.obj",
        &format!("file://{}", out.display()),
        out.to_str().expect("text"),
    ] {
        for options in [&plain, &ReadOptions::new().with_root(desk.join("in/pack"))] {
            let found = read(mesh, options);
            assert!(is_outside(&found), "{mesh}: {:?}", found.err());
        }
    }
    for package in ["..", ".", "", "in", "out"] {
        let error = read(&format!("package://{package}/cube.obj"), &plain).expect_err("no package");
        assert_eq!(*error.problem, Problem::UnknownPackage(package.to_owned()), "{error}");
    }
}

#[test]
fn the_packages_of_a_scene_lie_in_its_folder() {
    let desk = desk();
    let desk = desk.path();
    fs::write(desk.join("in/arm.urdf"), urdf("package://out/cube.obj")).expect("it is written");
    let text = |packages: &str| {
        format!(
            "{{\"dimension\": 3, \"robots\": [{{\"urdf\": \"arm.urdf\", \"packages\": [{packages:?}]}}]}}"
        )
    };
    let read = |packages: &str| Scene::from_json(desk.join("in/scene.json"), &text(packages));
    for packages in ["..", desk.to_str().expect("text"), "/"] {
        let error = read(packages).expect_err("a scene may not open other folders");
        assert_eq!(*error.problem, Problem::UnknownPackage("out".to_owned()), "{error}");
    }
    fs::write(desk.join("in/arm.urdf"), urdf("package://pack/meshes/cube.obj"))
        .expect("it is written");
    assert!(read(".").is_ok());
}

#[test]
fn the_file_that_is_asked_for_may_lie_anywhere() {
    let desk = desk();
    let root = ReadOptions::new().with_root(desk.path().join("out")).with_limits(Limits::default());
    assert!(load_with(&desk.path().join("in/cube.obj"), &root).is_ok());
    fs::write(desk.path().join("in/arm.urdf"), urdf("cube.obj")).expect("it is written");
    let robot = load_with(&desk.path().join("in/arm.urdf"), &root);
    assert!(is_outside(&robot), "but what it names lies in the root: {:?}", robot.err());
}

"""Closed meshes and polylines are solids in queries about points; open ones are errors unless `surface=True`."""

import impinge
import numpy as np
import pytest

CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
# Counter-clockwise from outside.
FACES = [
    *([0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1]),
    *([2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]),
]
SQUARE = [[-1, -1], [1, -1], [1, 1], [-1, 1]]
AROUND = [[0, 1], [1, 2], [2, 3], [3, 0]]
DTYPES = ["float32", "float64"]


def solid_and_surface(dim, dtype):
    """A cuboid, and its surface as a closed mesh or polyline."""
    cuboid = impinge.Cuboid([1] * dim, dtype=dtype)
    if dim == 3:
        return cuboid, impinge.TriMesh(CORNERS, FACES, dtype=dtype)
    return cuboid, impinge.Polyline(SQUARE, AROUND, dtype=dtype)


def open_shapes(dtype):
    return {
        "TriMesh": impinge.TriMesh(CORNERS, FACES[:-1], dtype=dtype),
        "Polyline": impinge.Polyline(SQUARE, dtype=dtype),
        "HeightField": impinge.HeightField(np.zeros((3, 3)), [2, 1, 2], dtype=dtype),
    }


def on_lattice(dim, dtype):
    """Lattice points inside, outside and on the boundary."""
    steps = np.linspace(-1.5, 1.5, 13)
    return np.stack(np.meshgrid(*[steps] * dim), axis=-1).reshape(-1, dim).astype(dtype)


@pytest.mark.parametrize("dtype", DTYPES)
@pytest.mark.parametrize("dim", [2, 3])
def test_a_closed_surface_answers_as_the_solid(dim, dtype):
    cuboid, surface = solid_and_surface(dim, dtype)
    points = on_lattice(dim, dtype)
    inside = impinge.contains(surface, None, points)
    assert (inside == impinge.contains(cuboid, None, points)).all() and 0.2 < inside.mean() < 0.6
    distance = impinge.signed_distance(surface, None, points)
    np.testing.assert_allclose(distance, impinge.signed_distance(cuboid, None, points), atol=1e-6)
    assert distance.dtype == dtype and (distance.min(), impinge.signed_distance(surface, None, [0.0] * dim)) == (-1, -1)
    # The result for a single point is a scalar.
    assert impinge.contains(surface, None, [0.0] * dim) is True and impinge.contains(surface, None, [9.0] * dim) is False


@pytest.mark.parametrize("dim", [2, 3])
def test_poses_and_several_shapes(dim):
    cuboid, surface = solid_and_surface(dim, "float64")
    turn = impinge.Poses([5, 1], angles=0.3) if dim == 2 else impinge.Poses([5, 1, 2], [0, 0, 0.6, 0.8], order="xyzw")
    points = on_lattice(dim, "float64") @ turn.matrices[:dim, :dim].T + turn.matrices[:dim, dim]
    near = np.abs(impinge.signed_distance(cuboid, turn, points)) > 1e-9
    assert (impinge.contains(surface, turn, points) == impinge.contains(cuboid, turn, points))[near].all()
    mixed = impinge.signed_distance([cuboid, surface, impinge.Ball(1, dim=dim)], None, [[0.25] + [0.0] * (dim - 1)] * 3)
    assert mixed.tolist() == [-0.75, -0.75, -0.75]
    picked = impinge.Picked([cuboid, surface], [1, 0, 1])
    assert impinge.contains(picked, None, [[0.0] * dim, [2.0] * dim, [2.0] * dim]).tolist() == [True, False, False]
    poses = np.tile(np.eye(dim + 1), (300, 1, 1))
    poses[:, 0, dim] = np.linspace(-2, 2, 300)
    for threads in (1, 2):
        found = impinge.contains(surface, poses, [0.0] * dim, threads=threads)
        assert (found == (np.abs(poses[:, 0, dim]) <= 1)).all()
    assert np.isinf(impinge.signed_distance(surface, None, [np.nan] * dim))
    assert not impinge.contains(surface, None, [np.inf] * dim)


@pytest.mark.parametrize("dim", [2, 3])
def test_a_compound_is_the_union_of_its_children(dim):
    cuboid, surface = solid_and_surface(dim, "float64")
    apart = impinge.Poses([[-3.0] + [0] * (dim - 1), [3.0] + [0] * (dim - 1)])
    compound = impinge.Compound([surface, impinge.Ball(1, dim=dim)], apart)
    nested = impinge.Compound([compound], impinge.Poses([[0.0] * dim]))
    points = np.zeros((5, dim))
    points[:, 0] = [-3, -2.5, 0, 3, 5]
    for shape in (compound, nested):
        assert impinge.contains(shape, None, points).tolist() == [True, True, False, True, False]
        assert impinge.signed_distance(shape, None, points).tolist() == [-1, -0.5, 2, -1, 1]


@pytest.mark.parametrize("dtype", DTYPES)
@pytest.mark.parametrize("name", ["TriMesh", "Polyline", "HeightField"])
def test_an_open_surface_is_refused_unless_it_is_called_one(name, dtype):
    shape = open_shapes(dtype)[name]
    points = np.full((2, shape.dim), 0.25)
    for ask in (impinge.contains, impinge.signed_distance):
        with pytest.raises(ValueError, match=f"shape has a {name} that is not closed.*surface=True"):
            ask(shape, None, points)
        with pytest.raises(ValueError, match=rf"shape\[1\] has a {name}"):
            ask([impinge.Ball(1, dim=shape.dim, dtype=dtype), shape], None, points)
    assert impinge.contains(shape, None, points, surface=True).tolist() == [False, False]
    distance = impinge.signed_distance(shape, None, points, surface=True)
    expected = np.linalg.norm(points - impinge.project_points(shape, None, points).point, axis=1)
    np.testing.assert_allclose(distance, expected, atol=1e-6)
    compound = impinge.Compound([shape], impinge.Poses([[0] * shape.dim]))
    with pytest.raises(ValueError, match=f"{name} that is not closed"):
        impinge.contains(compound, None, points)


def test_a_line_in_space_and_filled_triangles_in_the_plane():
    line = impinge.Polyline([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1], [1, 2], [2, 0]])
    with pytest.raises(ValueError, match="Polyline that is not closed"):
        impinge.contains(line, None, [0.2, 0.2, 0])
    filled = impinge.TriMesh([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]])
    assert impinge.contains(filled, None, [0.2, 0.2]) and impinge.signed_distance(filled, None, [2.0, 0]) == 1


def test_a_surface_turned_over_or_with_a_flipped_triangle():
    inside_out = impinge.TriMesh(CORNERS, np.array(FACES)[:, ::-1])
    assert impinge.contains(inside_out, None, [0, 0, 0]) and impinge.signed_distance(inside_out, None, [0, 0, 0]) == -1
    flipped = np.array(FACES)
    flipped[0] = flipped[0][::-1]
    with pytest.raises(ValueError, match="not closed"):
        impinge.contains(impinge.TriMesh(CORNERS, flipped), None, [0, 0, 0])


@pytest.mark.parametrize("dtype", DTYPES)
@pytest.mark.parametrize("dim", [2, 3])
def test_worlds(dim, dtype):
    cuboid, surface = solid_and_surface(dim, dtype)
    world = impinge.World(dim=dim, dtype=dtype)
    places = np.zeros((3, dim))
    places[:, 0] = [0, 5, 10]
    handles = world.add([surface, impinge.Ball(1, dim=dim, dtype=dtype), cuboid], impinge.Poses(places))
    rows = world.containing([[0.25] * dim, [5.0] + [0] * (dim - 1), [10.5] + [0] * (dim - 1), [2.0] * dim])
    assert rows.starts.tolist() == [0, 1, 2, 3, 3] and rows.handle.tolist() == handles.tolist()
    world.set_shapes(handles[:1], impinge.Ball(0.125, dim=dim, dtype=dtype))
    assert world.containing([0.25] * dim).handle.tolist() == []
    world.set_shapes(handles[:1], surface)
    world.set_poses(handles[:1], impinge.Poses([0.0] * (dim - 1) + [40.0]))
    assert world.containing([0.0] * (dim - 1) + [40.5]).handle.tolist() == [handles[0]]


def test_worlds_refuse_open_surfaces_that_are_asked():
    world = impinge.World()
    closed = world.add(impinge.TriMesh(CORNERS, FACES), None, membership=[1])
    terrain = world.add(open_shapes("float64")["HeightField"], impinge.Poses([0, -9, 0]), membership=[3])
    with pytest.raises(ValueError, match=f"the object {terrain[0]} has a HeightField that is not closed"):
        world.containing([0, 0, 0])
    assert world.containing([[0, 0, 0], [0.5, -9, 0.25]], surface=True).handle.tolist() == [closed[0], terrain[0]]
    for others in (impinge.Filter(exclude=terrain), impinge.Filter(blacklist=[3])):
        assert world.containing([0, 0, 0], filter=others).handle.tolist() == [closed[0]]
    # New vertices may open or close a mesh.
    bent = CORNERS.copy()
    world.remove(terrain)
    bent[7] *= 2
    world.set_vertices(closed[0], bent)
    assert world.containing([1.25, 1.25, 1.25]).handle.tolist() == [closed[0]]


def solid_of(dim, dtype="float64", **options):
    if dim == 3:
        return impinge.TriMesh(CORNERS * 4, FACES, dtype=dtype, **options)
    return impinge.Polyline(np.array(SQUARE) * 4.0, AROUND, dtype=dtype, **options)


@pytest.mark.parametrize("dtype", DTYPES)
@pytest.mark.parametrize("dim", [2, 3])
def test_a_solid_has_contacts_with_what_is_inside(dim, dtype):
    body, skin = solid_of(dim, dtype, solid=True), solid_of(dim, dtype)
    cuboid, ball = impinge.Cuboid([4] * dim, dtype=dtype), impinge.Ball(0.25, dim=dim, dtype=dtype)
    places = np.zeros((17, dim))
    places[:, 0] = np.linspace(-8, 8, 17)
    poses = impinge.Poses(places)
    expected = impinge.distance(cuboid, None, ball, poses)
    np.testing.assert_array_equal(impinge.distance(body, None, ball, poses), expected)
    np.testing.assert_array_equal(impinge.distance(ball, poses, body, None), expected)
    assert (impinge.distance(skin, None, ball, poses)[8], expected[8]) == (3.75, 0)
    found = impinge.contact(body, None, ball, poses)
    assert found.depth[11] == 1.25 and found.normal[11].tolist() == [1] + [0] * (dim - 1)
    inside = np.abs(places[:, 0]) <= 4
    assert (impinge.contains(body, None, places) == inside).all()
    assert impinge.contains(impinge.Compound([body], impinge.Poses([[0.0] * dim])), None, [1.0] * dim)


def test_a_solid_that_is_none_is_refused():
    with pytest.raises(ValueError, match=r"closed, but nothing is beyond the edge from vertex \d to \d of part \d"):
        impinge.TriMesh(CORNERS, FACES[:-1], solid=True)
    with pytest.raises(ValueError, match="front inside"):
        impinge.TriMesh(CORNERS, np.array(FACES)[:, ::-1], solid=True)
    with pytest.raises(ValueError, match="part 0 ends at vertex 0"):
        impinge.Polyline(SQUARE, solid=True)
    # In 2D the triangles of a mesh are filled.
    filled = impinge.TriMesh(SQUARE, [[0, 1, 2], [0, 2, 3]], solid=True)
    assert impinge.distance(filled, None, impinge.Ball(0.1, dim=2), impinge.Poses([0.5, 0.25])) == 0


@pytest.mark.parametrize("dim", [2, 3])
def test_a_solid_in_a_world(dim):
    world = impinge.World(dim=dim)
    body = world.add(solid_of(dim, solid=True), None)
    ball = world.add(impinge.Ball(0.25, dim=dim), impinge.Poses([20.0] + [0.0] * (dim - 1)))
    world.update()
    assert world.containing([[0.5] * dim]).handle.tolist() == [body]
    assert len(world.contacts()) == 0
    world.set_poses(ball, impinge.Poses([3.0] + [0.0] * (dim - 1)))
    world.update()
    assert world.contacts()["depth"].tolist() == [1.25]

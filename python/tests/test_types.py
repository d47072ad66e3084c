"""No public result has the type `Any`, which disables type checks; `typed_answers.py` has the types of calls."""

import ast
import re
from pathlib import Path

import impinge
import pytest

PACKAGE = Path(impinge.__file__).parent
# Modules whose public names are those without an underscore, because they have no `__all__`.
OPEN = ["dask", "urdf"]
# The scalar types of NumPy with unknown precision.
PRECISION = re.compile(r"\b(floating|integer)\[Any\]")
# Public names whose type may contain `Any`, with the reason.
ALLOWED: dict[str, str] = {}


def trees():
    """The modules by name, as type checkers read them: a stub replaces its source."""
    files = [*sorted(PACKAGE.glob("*.py")), *sorted(PACKAGE.glob("*.pyi"))]
    return {path.stem: ast.parse(path.read_text()) for path in files}


def names(tree):
    """The names that a module defines, with their nodes."""
    for node in tree.body:
        for inner in [*node.body, *node.orelse] if isinstance(node, ast.If) else [node]:
            if isinstance(inner, ast.FunctionDef | ast.ClassDef):
                yield inner.name, inner
            elif isinstance(inner, ast.AnnAssign) and isinstance(inner.target, ast.Name):
                yield inner.target.id, inner
            elif isinstance(inner, ast.Assign):
                yield from ((target.id, inner) for target in inner.targets if isinstance(target, ast.Name))


def exported(tree):
    """The strings of `__all__`."""
    return [text.value for name, node in names(tree) if name == "__all__" for text in node.value.elts]


def is_any(text, tainted):
    """Whether a type is `Any`, or contains it."""
    return any(re.search(rf"\b{name}\b", PRECISION.sub("", text)) for name in ["Any", *tainted])


def aliases(modules):
    """The names of type aliases that contain `Any`."""
    tainted = set()
    while True:
        found = {
            name
            for tree in modules.values()
            for name, node in names(tree)
            if isinstance(node, ast.Assign | ast.AnnAssign) and node.value and name != "__all__"
            if isinstance(node, ast.Assign) or ast.unparse(node.annotation) == "TypeAlias"
            if is_any(ast.unparse(node.value), tainted)
        }
        if found <= tainted:
            return tainted
        tainted |= found


def answers(name, node, classes):
    """The functions, fields and attributes of a public name, with their types."""
    if isinstance(node, ast.FunctionDef):
        yield name, "" if node.returns is None else ast.unparse(node.returns)
        for inner in ast.walk(node):
            if isinstance(inner, ast.AnnAssign) and ast.unparse(inner.target).startswith("self."):
                yield f"{name.rpartition('.')[0]}.{inner.target.attr}", ast.unparse(inner.annotation)
    elif isinstance(node, ast.AnnAssign):
        yield name, ast.unparse(node.annotation)
    elif isinstance(node, ast.ClassDef):
        for base in node.bases:
            if ast.unparse(base) in classes:
                yield from answers(name, classes[ast.unparse(base)], classes)
        for inner in node.body:
            own = getattr(inner, "name", None) or ast.unparse(getattr(inner, "target", inner))
            yield from answers(f"{name}.{own}", inner, classes)


def definition(modules, module, name):
    """The definition of a name that a module defines or imports."""
    own = dict(names(modules[module]))
    if name in own:
        return own[name]
    for node in modules[module].body:
        if isinstance(node, ast.ImportFrom) and name in [alias.name for alias in node.names]:
            return definition(modules, node.module.removeprefix("impinge."), name)
    raise AssertionError(f"{module} exports {name}, which it lacks")


def public(modules):
    """Every public name with its definition."""
    for module in ("__init__", "trimesh"):
        yield from ((f"{module}.{name}", definition(modules, module, name)) for name in exported(modules[module]))
    for module in OPEN:
        yield from ((f"{module}.{name}", node) for name, node in names(modules[module]) if not name.startswith("_"))


def is_private(path):
    return any(re.match("_[^_]", part) for part in path.split(".")[1:])


def found():
    modules = trees()
    tainted = aliases(modules)
    classes = {name: node for tree in modules.values() for name, node in names(tree) if isinstance(node, ast.ClassDef)}
    every = {row for name, node in public(modules) for row in answers(name, node, classes) if not is_private(row[0])}
    return every, {path for path, text in every if is_any(text, tainted)}


def test_no_answer_is_any():
    every, wrong = found()
    assert wrong == set(ALLOWED)
    paths = {path for path, _ in every}
    assert {"__init__.distance", "__init__.Contact.depth", "__init__.World.cast_rays", "__init__.Shape.faces"} <= paths
    assert {"trimesh.CollisionManager.min_distance_other", "urdf.Robot.frames", "dask.ask_scene"} <= paths
    assert {"__init__.Poses.matrices", "__init__.Scene.poses", "trimesh.ContactData.normal"} <= paths


@pytest.mark.parametrize("text", ["Any", "NDArray[Any]", "list[Any] | None", "Array", "Callable[..., Any]"])
def test_any_is_seen(text):
    assert is_any(text, {"Array"})


@pytest.mark.parametrize("text", ["NDArray[np.floating[Any]]", "float | Floats", "Anything"])
def test_what_is_no_any(text):
    assert not is_any(text, {"Array"})


def test_the_stub_has_the_fields_of_the_classes():
    """`_results.py` and its stub define the same fields."""
    stub = dict(names(trees()["_results"]))
    classes = [kind for kind in vars(impinge).values() if getattr(kind, "__module__", "") == "impinge._results"]
    assert len(classes) == 9
    for kind in classes:
        fields = [node.target.id for node in stub[kind.__name__].body if isinstance(node, ast.AnnAssign)]
        assert tuple(fields) == getattr(kind, "_fields", ())

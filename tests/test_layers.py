"""Imports run downwards only."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
PACKAGES = [ROOT / "webviz", *(ROOT / d for d in ("displays", "urdf", "sim"))]
MODULES = sorted(path for package in PACKAGES for path in package.rglob("*.py"))

EDGES = {"webviz.ros": "rclpy", "webviz.scene": "viser", "webviz.gui": "viser"}
TOP = (
    "webviz.frame_loop",
    "webviz.app",
    "webviz.pictures",
    "webviz.testing",
    "webviz.pytest_plugin",
    "webviz.cli",
    "webviz.__main__",
)
LAZY = "webviz"
"""Names what stands at the top, but imports it only when somebody asks for it."""


def name_of(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    parts = parts[1:] if parts[0] != "webviz" else parts
    return ".".join(parts).removesuffix(".__init__")


def imports(path: Path) -> Iterator[str]:
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import"
            yield node.module or ""
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def is_within(name: str, *packages: str) -> bool:
    return any(name == package or name.startswith(f"{package}.") for package in packages)


@pytest.fixture(params=MODULES, ids=lambda path: name_of(path))
def module(request: pytest.FixtureRequest) -> tuple[str, set[str]]:
    return name_of(request.param), set(imports(request.param))


def test_rclpy_stays_at_the_ros_edge(module: tuple[str, set[str]]) -> None:
    name, imported = module
    if not is_within(name, "webviz.ros", "webviz_sim"):
        assert not [i for i in imported if is_within(i, "rclpy", "rosidl_runtime_py")]


def test_viser_stays_at_the_scene_and_the_panel(module: tuple[str, set[str]]) -> None:
    name, imported = module
    if not is_within(name, "webviz.scene", "webviz.gui"):
        assert not [i for i in imported if is_within(i, "viser")]


def test_the_edges_do_not_import_each_other(module: tuple[str, set[str]]) -> None:
    name, imported = module
    for edge in EDGES:
        if is_within(name, edge):
            others = [other for other in EDGES if other != edge]
            assert not [i for i in imported if is_within(i, *others)]


def test_only_the_top_knows_the_edges_and_the_top(module: tuple[str, set[str]]) -> None:
    name, imported = module
    if name == LAZY or is_within(name, *TOP):
        return
    own_edge = [edge for edge in EDGES if is_within(name, edge)]
    above = [*TOP, *(edge for edge in EDGES if edge not in own_edge)]
    if is_within(name, "webviz_sim"):
        above.remove("webviz.ros")
    assert not [i for i in imported if is_within(i, *above)]


def test_foundations_know_nothing_of_what_stands_on_them(module: tuple[str, set[str]]) -> None:
    name, imported = module
    if is_within(name, "webviz.messages", "webviz.transforms"):
        foreign = [i for i in imported if is_within(i, "webviz") and not is_within(i, name)]
        allowed = ("webviz.messages", "webviz.transforms")
        assert not [i for i in foreign if not is_within(i, *allowed)]


def test_displays_know_the_public_api_only(module: tuple[str, set[str]]) -> None:
    name, imported = module
    if is_within(name, "webviz_displays"):
        webviz = {i for i in imported if is_within(i, "webviz")}
        inner = {i for i in webviz if i.count(".") > 1 and not is_within(i, "webviz.transforms")}
        assert not inner


def test_the_simulator_shares_only_messages(module: tuple[str, set[str]]) -> None:
    name, imported = module
    if is_within(name, "webviz_sim"):
        shared = [i for i in imported if is_within(i, "webviz", "webviz_displays")]
        messages = ("webviz.ros.types", "webviz.messages")
        assert not [i for i in shared if not is_within(i, *messages)]

"""A room imports only itself and those before it in the table of ARCHITECTURE.md."""

import ast
import graphlib
import re
from collections import defaultdict
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from webviz.api.registry import display_types
from webviz.engine.feature import features
from webviz.engine.parts.declaring import stores_of

ROOT = Path(__file__).parent.parent
FEATURES = ROOT / "webviz/features"
PACKAGES = [ROOT / "webviz", *(ROOT / d for d in ("displays", "urdf", "sim"))]

ROOMS = (
    "webviz.data",
    "webviz.api",
    "webviz.files",
    "webviz.sources",
    "webviz.engine",
    "webviz.ros",
    "webviz.server",
    "webviz.scene",
    "webviz.page",
    "webviz.checks",
    "webviz.tools",
    "webviz.panels",
    "webviz.features",
    "webviz.shell",
)
"""Each may import itself and those before it."""
FACES = ("webviz", "webviz.__main__", "webviz.commands", "webviz.testing", "webviz.transforms")
"""Public names, under which nothing inside webviz is imported."""
CALLERS = ("webviz.ros", "webviz.page", "webviz.panels", "webviz.shell")
"""Rooms that send commands, whose classes follow from methods of parts and features."""
FOLDERS = {
    "webviz.engine": (
        "store",
        "forms",
        "state",
        "commands",
        "error_boundary",
        "requests",
        "driving",
        "path_numbers",
        "pipeline",
        "parts",
        "examiner",
        "machine",
        "feature",
        "loop",
    ),
    "webviz.server": ("access", "sending", "channel", "images", "http"),
}
"""Folders of a room, each of which may import itself and those before it."""
UNRELATED = (
    ("webviz.ros", "webviz.server"),
    ("webviz.ros", "webviz.scene"),
    ("webviz.ros", "webviz.page"),
    ("webviz.scene", "webviz.page"),
)
"""Pairs of rooms that do not know each other."""
EDGES = {
    "rclpy": ("webviz.ros", "webviz_sim"),
    "rosidl_runtime_py": ("webviz.ros", "webviz_sim"),
    "viser": ("webviz.scene", "webviz.server.http"),
}
"""Rooms that may import a library."""
YAML_READER = "webviz.data.plain_yaml"
"""The only module that reads YAML, and so bounds it."""
YAML_NODES = ("ruamel.yaml.nodes", "ruamel.yaml.representer")
"""Parts of the library that others may know: those of documents, and how values are written."""
MESSAGES = "webviz.data.messages"
SHARED_WITH_THE_SIMULATOR = (
    MESSAGES,
    "webviz.data.rotations",
    "webviz.data.map_file",
    "webviz.ros.distribution",
    "webviz.ros.types",
)
PUBLIC = ("webviz.api", "webviz.data")
"""Modules that displays and tools may import besides `webviz` itself."""


def name_of(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    parts = parts[1:] if parts[0] != "webviz" else parts
    return ".".join(parts).removesuffix(".__init__")


MODULES = {name_of(path): path for package in PACKAGES for path in sorted(package.rglob("*.py"))}


@cache
def imports(name: str) -> frozenset[str]:
    """The modules of the project, and the libraries, that a module imports anywhere."""
    return frozenset(_imports(MODULES[name]))


def _imports(path: Path) -> Iterator[str]:
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import"
            for alias in node.names:
                inner = f"{node.module}.{alias.name}"
                yield inner if inner in MODULES else node.module or ""


def is_within(name: str, *packages: str) -> bool:
    return any(name == package or name.startswith(f"{package}.") for package in packages)


def test_the_architecture_lists_the_rooms_in_the_order_of_their_imports() -> None:
    text = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8")
    rooms = re.findall(r"^\| `webviz/(\w+)/`", text, re.MULTILINE)
    assert [f"webviz.{room}" for room in rooms] == [room for room in ROOMS if room in MODULES]


@pytest.mark.parametrize("room", ROOMS)
def test_a_room_imports_itself_and_those_before_it(room: str) -> None:
    above = ROOMS[ROOMS.index(room) + 1 :]
    wrong = {
        (name, other)
        for name in MODULES
        if is_within(name, room)
        for other in imports(name)
        if is_within(other, *above) or other in FACES
        # Commands of features are found at run time, as their names.
        if not (other == "webviz.commands" and is_within(name, *CALLERS))
    }
    assert not wrong


def test_every_module_has_a_room() -> None:
    assert not [n for n in MODULES if n.startswith("webviz.") and not is_within(n, *ROOMS, *FACES)]


def test_no_modules_import_each_other_in_a_circle() -> None:
    graph = {
        name: {other for other in imports(name) if other in MODULES and not is_outer(name, other)}
        for name in MODULES
        if name not in FACES
    }
    assert list(graphlib.TopologicalSorter(graph).static_order())


GENERATED = {"constants.js", "contents.js", "messages.js", "types.js"}
"""Modules of the page that are generated, or contain only types."""


def modules_of_the_page() -> dict[str, set[str]]:
    """Return the modules that each one of the page imports, by their addresses there."""
    folders = {"": ROOT / "webviz/page/web", "features/": FEATURES}
    return {
        prefix + path.relative_to(folder).as_posix(): {
            *re.findall(r'(?:from|import) "webviz/([^"]+)"', path.read_text("utf-8"))
        }
        for prefix, folder in folders.items()
        for path in folder.rglob("*.js")
    }


def test_modules_of_the_page_import_each_other_by_name() -> None:
    """Modules have no address in the page's one file that a path could start from."""
    paths = {
        path.name
        for folder in (ROOT / "webviz/page/web", FEATURES)
        for path in folder.rglob("*.js")
        if re.search(r'(?:from|import|import\() ?"\.', path.read_text("utf-8"))
    }
    assert paths == set()


def test_no_modules_of_the_page_import_each_other_in_a_circle() -> None:
    graph = modules_of_the_page()
    assert len(graph) > 100
    imported = {other for others in graph.values() for other in others}
    assert {each for each in imported if Path(each).name not in GENERATED} <= graph.keys()
    assert list(graphlib.TopologicalSorter(graph).static_order())


PAGE_FOLDERS = (
    "",
    "controls",
    "docks",
    "scene",
    "charts",
    "tools",
    "panels",
    "images",
    "shell",
    "overlay",
    "recorded",
)
"""Folders of the page's modules, each of which imports only itself and those before it."""
PAGE_ENTRIES = {"main.js", "extensions.js"}
"""Modules that start the others, and that hand them to plug-ins."""


def test_the_folders_of_the_page_import_in_one_direction() -> None:
    graph = modules_of_the_page()
    own = {name for name in graph if not name.startswith("features/")} - PAGE_ENTRIES
    ranks = {name: PAGE_FOLDERS.index(name.split("/")[0] if "/" in name else "") for name in own}
    wrong = {
        (name, other)
        for name in own
        for other in graph[name]
        if other in PAGE_ENTRIES or ranks.get(other, 0) > ranks[name]
    }
    assert not wrong


def test_features_are_named_outside_their_folder_only_by_their_exports() -> None:
    wrong = {
        (name, other)
        for name in MODULES
        for other in imports(name)
        if is_within(other, "webviz.features") and other != "webviz.features"
        if not is_within(name, feature_of(other))
        # Features meet through what one exports.
        if not (is_within(name, "webviz.features") and other == feature_of(other))
    }
    wrong |= {
        (name, other)
        for name, others in modules_of_the_page().items()
        for other in others
        if other.startswith("features/") and name.split("/")[:2] != other.split("/")[:2]
    }
    # Nor in a docstring.
    wrong |= {
        (name, each)
        for name, path in MODULES.items()
        if not is_within(name, "webviz.features")
        for each in re.findall(r"webviz[./]features[./]\w+", path.read_text("utf-8"))
    }
    assert not wrong


STORES_IN_THE_PAGE = {
    "controls/permission.js": {"permission"},
}
"""Stores of features that modules of the page itself read, each in one place."""


def test_the_page_itself_reads_no_other_stores_of_features() -> None:
    of_features = {name for feature in features().values() for name in stores_of(feature)}
    read = {
        name: own
        for name, text in texts_of_the_page().items()
        if (own := set(re.findall(r'\b(?:store|ownStore|watch)\([`"](\w+)', text)) & of_features)
    }
    assert read == STORES_IN_THE_PAGE


def test_the_page_itself_opens_no_panel_of_a_feature() -> None:
    open_features = {
        (name, panel)
        for name, text in texts_of_the_page().items()
        for panel in re.findall(r'\bopenPanel\("(\w+)"', text)
    }
    assert open_features
    assert {panel for _, panel in open_features} == {"displays"}


def texts_of_the_page() -> dict[str, str]:
    """Return the modules of the page that are no feature's by their names."""
    page = ROOT / "webviz/page/web"
    return {p.relative_to(page).as_posix(): p.read_text("utf-8") for p in page.rglob("*.js")}


def feature_of(module: str) -> str:
    """Return the package of the feature that a module belongs to."""
    return ".".join(module.split(".")[:3])


def is_outer(name: str, other: str) -> bool:
    """Return whether a module names the package that it is in, or the public face of all."""
    return other in FACES or name == other or name.startswith(f"{other}.")


def test_libraries_stay_at_their_edges() -> None:
    wrong = {
        (name, library)
        for library, edges in EDGES.items()
        for name in MODULES
        if not is_within(name, *edges)
        if any(is_within(other, library) for other in imports(name))
    }
    assert not wrong


def test_yaml_is_read_by_one_module() -> None:
    readers = {
        name
        for name in MODULES
        for other in imports(name)
        if is_within(other, "ruamel", "yaml", "strictyaml", "oyaml")
        and not is_within(other, *YAML_NODES)
    }
    assert readers == {YAML_READER}


@pytest.mark.parametrize("room", FOLDERS)
def test_the_folders_of_a_room_import_in_one_direction(room: str) -> None:
    folders = [f"{room}.{folder}" for folder in FOLDERS[room]]
    inside = {name for name in MODULES if is_within(name, room) and name != room}
    assert not {name for name in inside if not is_within(name, *folders)}
    wrong = {
        (name, other)
        for index, folder in enumerate(folders)
        for name in inside
        if is_within(name, folder)
        for other in imports(name)
        if is_within(other, *folders[index + 1 :])
    }
    assert not wrong


@pytest.mark.parametrize("pair", UNRELATED)
def test_some_rooms_do_not_know_each_other(pair: tuple[str, str]) -> None:
    wrong = {
        (name, other)
        for room, foreign in (pair, pair[::-1])
        for name in MODULES
        if is_within(name, room)
        for other in imports(name)
        if is_within(other, foreign)
    }
    assert not wrong


@pytest.mark.parametrize("package", ["webviz_displays", "webviz.tools"])
def test_displays_and_tools_know_the_public_api_only(package: str) -> None:
    wrong = {
        (name, other)
        for name in MODULES
        if is_within(name, package)
        for other in imports(name)
        if other.startswith("webviz.") and not is_within(other, *PUBLIC, package)
    }
    assert not wrong


def test_the_simulator_shares_only_messages_and_their_types() -> None:
    wrong = {
        (name, other)
        for name in MODULES
        if is_within(name, "webviz_sim")
        for other in imports(name)
        if is_within(other, "webviz", "webviz_displays")
        and not is_within(other, *SHARED_WITH_THE_SIMULATOR)
    }
    assert not wrong


def test_modules_stay_small() -> None:
    long = {n: c for n, p in MODULES.items() if (c := p.read_text().count("\n")) > 400}
    assert not long


def test_no_two_classes_share_a_name() -> None:
    """Displays are called as in RViz and messages as in ROS, whatever else has that name."""
    displays = {(cls.__module__, cls.__name__) for cls in display_types().values()}
    modules = {name: path for name, path in MODULES.items() if not is_within(name, MESSAGES)}
    named = defaultdict[str, list[str]](list)
    for module, path in modules.items():
        for node in ast.parse(path.read_text()).body:
            if isinstance(node, ast.ClassDef) and (module, node.name) not in displays:
                named[node.name].append(module)
    shared = {name: where for name, where in named.items() if len(where) > 1}
    assert not {name: where for name, where in shared.items() if not name.startswith("_")}

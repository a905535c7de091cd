"""All doors by which bytes come in, with the attacks on each.

A module belongs to a door if it reads a file, a socket, a process or a topic, or parses a format of
somebody else; `test_doors.py` finds these modules by the calls in ENTRIES.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from fnmatch import fnmatchcase
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]
PRODUCT = ("webviz", "displays", "urdf", "sim")
ENTRIES = {
    *("open", "read_bytes", "read_text", "fdopen", "mmap", "connect", "create_connection", "recv"),
    *("Popen", "create_subscription", "urlopen", "build_opener", "fromstring", "iterparse"),
    *("YAML", "decompress", "decompressobj", "CodecContext", "frombuffer"),
    *("unpack", "unpack_from", "iter_unpack", "load_mesh"),
    *("json.loads", "json.decode", "msgpack.decode", "cbor2.loads", "pickle.loads", "Image.open"),
    *("json.Decoder", "msgpack.Decoder"),
}
"""Functions and methods by which bytes enter or are parsed, some with the object before them."""


class Door(NamedTuple):
    """One way in.

    Args:
        attacks: kinds of attacks on it; none where no other program writes the bytes.
        modules: patterns of the modules behind it, from the checkout's root.
        reason: why it is not attacked, "" if it is.
    """

    attacks: tuple[str, ...]
    modules: tuple[str, ...]
    reason: str = ""


DOORS: Mapping[str, Door] = {
    "topics": Door(
        ("dds", "graphs", "weights", "definitions"),
        (
            "webviz/ros/*",
            "webviz/data/transforms/*",
            "webviz/engine/pipeline/*",
            "webviz/data/messages/*",
            "webviz/data/foxglove/*",
            "displays/webviz_displays/*",
            "webviz/api/bounds.py",
            "webviz/data/gltf.py",
            "webviz/scene/*",
            "webviz/shell/app/*",
        ),
    ),
    "images and videos": Door(("media", "weights"), ("webviz/data/images/*",)),
    "bags": Door(
        ("files", "bombs", "disks", "clocks"),
        (
            "webviz/data/recordings/*",
            "webviz/sources/player.py",
            "webviz/sources/bag/*",
            "webviz/features/bags/*",
            "webviz/features/black_box/*",
        ),
    ),
    "bug reports": Door(("reports",), ("webviz/files/report/*", "webviz/shell/report/*")),
    "bridges": Door(("bridges",), ("webviz/sources/bridge/*", "webviz/sources/fleet/*")),
    "networks of Zenoh": Door(("zenoh",), ("webviz/sources/zenoh/*",)),
    "robot descriptions and meshes": Door(("files",), ("urdf/webviz_urdf/*",)),
    "configs": Door(
        ("files", "uploads", "saving"),
        (
            "webviz/files/config/*",
            "webviz/files/rviz/*",
            "webviz/files/opening.py",
            "webviz/engine/parts/config.py",
            "webviz/features/files/__init__.py",
            "webviz/files/sessions.py",
            "webviz/data/working_folder.py",
            "webviz/shell/cli/convert.py",
        ),
    ),
    "texts of others in YAML": Door(("yaml texts",), ("webviz/data/plain_yaml.py",)),
    "names in terminals": Door(("terminals",), ("webviz/shell/cli/*",)),
    "maps": Door(("files", "yaml texts"), ("webviz/data/map_file.py",)),
    "tiles": Door(("tiles", "tile addresses"), ("webviz/data/tiles/*",)),
    "pages": Door(
        (
            "ws no token",
            "ws watcher",
            "ws operator",
            "ws owner",
            "http",
            "crowds",
            "queues",
            "spreadsheets",
        ),
        (
            "webviz/server/channel/*",
            "webviz/server/http/*",
            "webviz/page/*",
            "webviz/panels/*",
            "webviz/features/transforms/__init__.py",
            "webviz/engine/parts/displays.py",
        ),
    ),
    "agents": Door(("agents",), ("webviz/shell/agents/*",)),
    "exported files": Door(("exported",), ("webviz/shell/export/*", "webviz/features/sharing/*")),
    "the simulator's topics": Door(("simulator",), ("sim/webviz_sim/*",)),
    "other machines": Door(
        (),
        (
            "webviz/data/machine_memory.py",
            "webviz/shell/doctor/*",
            "webviz/engine/machine/*",
            "webviz/features/doctor/*",
        ),
        "The kernel, and a machine that the user logs in to (tests/checks/test_peer.py).",
    ),
    "the user's own files": Door(
        (),
        (
            "webviz/api/modules.py",
            "webviz/engine/feature.py",
            "webviz/server/access/*",
            "webviz/shell/docs.py",
            "webviz/shell/cli/new.py",
            "webviz/shell/testing/*",
            "webviz/shell/reference.py",
            "webviz/features/outputs/*",
            "webviz/features/reports/writing.py",
        ),
        "Tokens, certificates, plug-ins and templates of the user who starts webviz.",
    ),
    "browsers of pictures": Door(
        ("exported",), ("webviz/shell/pictures/*", "webviz/shell/cli/frames.py")
    ),
}


def modules() -> Iterator[str]:
    """Yield the modules of the product, from the checkout's root."""
    for folder in PRODUCT:
        for path in sorted((ROOT / folder).rglob("*.py")):
            yield path.relative_to(ROOT).as_posix()


def entries() -> Iterator[str]:
    """Yield those that read or parse bytes."""
    for module in modules():
        nodes = ast.walk(ast.parse((ROOT / module).read_text()))
        if any(map(_is_entry, nodes)):
            yield module


def doors_of(module: str) -> list[str]:
    """Return the doors that a module is behind, those with the longest pattern first."""
    results = [
        (len(pattern), name)
        for name, door in DOORS.items()
        for pattern in door.modules
        if fnmatchcase(module, pattern)
    ]
    return [name for _, name in sorted(results, reverse=True)]


def _is_entry(node: ast.AST) -> bool:
    if not isinstance(node, ast.Call):
        return False
    if isinstance(node.func, ast.Name):
        return node.func.id in ENTRIES
    if not isinstance(node.func, ast.Attribute):
        return False
    owner = ast.unparse(node.func.value).rpartition(".")[2]
    return node.func.attr in ENTRIES or f"{owner}.{node.func.attr}" in ENTRIES

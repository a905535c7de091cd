"""The table of what reaches into viser is complete, and has no row that has gone."""

from __future__ import annotations

import ast
import functools
import re
from pathlib import Path

import webviz
from tests.scene.viser_parts import ADAPTER, CLIENT, HTTP, PAGE, SERVER

ROOT = Path(webviz.__file__).parent.parent
ROOMS = (f"{ADAPTER}/", f"{HTTP}/", f"{PAGE}/scene/")
ALONE = {f"{PAGE}/viser_page.js", f"{PAGE}/globals.d.ts"}
"""Besides these rooms, the files of the page that name viser's global."""

IN_PAGE = re.compile(
    r"__viser\w*|__r3f|Worker\.prototype\.\w+(?= =)|history\.replaceState(?= =)"
    r"|Raycaster\(\)\.prototype|onBeforeCompile(?= = )|(?:vertex|fragment)Shader(?= = )"
    r"|document\.currentScript\.dataset"
)


def of_python(text: str) -> set[str]:
    """Private modules of viser that are imported; and private attributes, if viser is."""
    tree = ast.parse(text)
    imported, attributes = set[str](), set[str]()
    is_viser = False
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names = [name.name for name in node.names]
        elif isinstance(node, ast.ImportFrom):
            names = [f"{node.module}.{name.name}" for name in node.names]
        else:
            names = []
        for name in names:
            if name.split(".")[0] == "viser":
                is_viser = True
                imported |= {name} if re.search(r"\.(_|infra\b)", name) else set()
        if isinstance(node, ast.Attribute) and re.fullmatch(r"_[a-z]\w*", node.attr):
            is_own = isinstance(node.value, ast.Name) and node.value.id in ("self", "cls")
            attributes |= set() if is_own else {node.attr}
    return imported | (attributes if is_viser else set()) | set(IN_PAGE.findall(text))


@functools.cache
def viser_references() -> dict[str, set[str]]:
    """Parts that are used, by file."""
    reaches: dict[str, set[str]] = {}
    for folder in ("webviz", "displays", "sim"):
        for file in (ROOT / folder).rglob("*"):
            if file.suffix in (".py", ".js", ".ts", ".html"):
                text = file.read_text("utf-8")
                has_viser = file.suffix == ".py" and "viser" in text
                parts = of_python(text) if has_viser else set(IN_PAGE.findall(text))
                if parts:
                    reaches[file.relative_to(ROOT).as_posix()] = parts
    return reaches


def test_all_that_reaches_into_viser_is_in_the_table_with_a_reason() -> None:
    listed = {row.file: set(row.parts) for row in (*SERVER, *CLIENT)}
    assert viser_references() == listed
    assert all(row.why and row.upstream for row in (*SERVER, *CLIENT))


def test_only_three_rooms_reach_into_viser() -> None:
    outside = {name for name in viser_references() if not name.startswith(ROOMS)}
    assert outside == ALONE

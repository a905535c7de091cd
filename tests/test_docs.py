"""The pages match the displays, and the links and files that they name exist."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import demo_picture
import PIL.Image
import pytest

import webviz
from webviz.api.registry import display_types
from webviz.shell import check_docs, docs, typings
from webviz.shell.reference import ENVIRONMENT

GUIDES = [docs.ROOT / name for name in ("README.md", "CONTRIBUTING.md", "ARCHITECTURE.md")]
DOCUMENTS = sorted([*docs.PAGES.rglob("*.md"), *GUIDES])
GENERATED = docs.pages()
DRAWING = [
    name
    for name, cls in display_types().items()
    if cls.__module__ != "webviz.api.group" and not cls.reports_only
]
SOURCES = docs.ROOT / "displays/webviz_displays"


def links(text: str) -> list[str]:
    """Targets of links and pictures of a Markdown text."""
    return re.findall(r"\]\(([^)\s]+)\)", text)


@cache
def anchors(page: Path) -> set[str]:
    """Return the targets of links in a page: its headings as GitHub names them."""
    headings = re.findall(r"^#+ (.+)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def test_pages_are_as_the_declarations_say() -> None:
    for name, text in GENERATED.items():
        committed = (docs.PAGES / name).read_text(encoding="utf-8")
        assert committed == text, f"{name}: run {docs.COMMAND} and commit displays/docs"


def test_every_check_has_a_page() -> None:
    result = check_docs.pages()
    folder = docs.PAGES / check_docs.FOLDER
    committed = {path.name: path.read_text(encoding="utf-8") for path in folder.iterdir()}
    assert committed.keys() == {"README.md", *result}
    assert [name for name in result if committed[name] != result[name]] == [], f"run {docs.COMMAND}"


def test_the_types_of_the_page_are_those_of_python() -> None:
    for path, text in typings.files().items():
        committed = path.read_text(encoding="utf-8")
        assert committed == text, f"run {docs.COMMAND} and commit {path.name}"


def test_every_environment_variable_is_in_the_reference() -> None:
    sources = [path for name in ("webviz", "urdf") for path in (docs.ROOT / name).rglob("*.py")]
    text = "".join(path.read_text(encoding="utf-8") for path in sources)
    used = {*re.findall(r"WEBVIZ_[A-Z]+(?:_[A-Z]+)*(?!_)\b", text), *re.findall(r"XDG_\w+", text)}
    assert len(used) > 4
    assert used <= {*ENVIRONMENT}


def test_every_name_of_the_api_is_described() -> None:
    headings = re.findall(r"^## (\w+)\n\n(.*)$", GENERATED["api.md"], re.MULTILINE)
    assert [name for name, text in headings if len(text) > 10] == sorted(webviz.__all__)


def test_there_is_no_page_of_a_removed_display() -> None:
    assert {path.name for path in docs.PAGES.glob("*.md")} == GENERATED.keys()


def test_every_link_leads_to_a_file_and_a_heading() -> None:
    for path in DOCUMENTS:
        for link in links(path.read_text(encoding="utf-8")):
            if link.startswith(("http://", "https://")):
                continue
            file, _, anchor = link.partition("#")
            target = (path.parent / file).resolve() if file else path
            assert target.exists(), f"{path}: {link} leads nowhere"
            assert target.is_relative_to(docs.ROOT), f"{path}: {link} leads out of the project"
            if anchor:
                assert anchor in anchors(target), f"{path}: no heading {link}"


def test_every_file_that_guides_name_exists() -> None:
    named = re.findall(r"`([\w./-]+)`", "".join(path.read_text("utf-8") for path in GUIDES))
    folders = {each.name for each in docs.ROOT.iterdir() if each.is_dir()}
    files = [each for each in named if each.split("/")[0] in folders and "/" in each]
    assert [each for each in files if not (docs.ROOT / each).exists()] == []
    assert [each for each in named if re.fullmatch(r"webviz(\.\w+)+\.py", each)] == []


def test_every_promise_is_held_by_tests_that_exist() -> None:
    promised = (docs.ROOT / "SECURITY.md").read_text(encoding="utf-8")
    bullets = re.findall(r"^- (.+(?:\n  .+)*)", promised, re.MULTILINE)
    table = (
        (docs.ROOT / "tests/PROMISES.md").read_text(encoding="utf-8").partition("|---|---|\n")[2]
    )
    rows = [row.strip("| ").rsplit(" | ", 1) for row in table.splitlines()]
    assert rows
    assert [" ".join(each.split()) for each in bullets] == [promise for promise, _ in rows]
    for _, tests in rows:
        named = re.findall(r"`(tests/[\w/]+\.py)::(\w+)`", tests)
        assert named, tests
        for path, test in named:
            source = (docs.ROOT / path).read_text(encoding="utf-8")
            assert f"\ndef {test}(" in source, f"{path}::{test}"


@pytest.mark.parametrize("path", GUIDES, ids=lambda path: path.name)
def test_every_file_that_a_guide_names_exists(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    named = re.findall(r"(?<![\w./-])((?:webviz|displays|urdf|sim|tests)/[\w./-]*)", text)
    assert named
    assert [name for name in named if not (docs.ROOT / name.rstrip(".")).exists()] == []


def test_every_picture_of_a_display_is_shown() -> None:
    pictures = {link for text in GENERATED.values() for link in links(text)}
    stories = (docs.PAGES / "stories").glob("*.md")
    pictures |= {link.removeprefix("../") for p in stories for link in links(p.read_text())}
    for folder in docs.PICTURES.iterdir():
        if (docs.PAGES / f"{folder.name}.md").exists() or folder.name == "stories":
            for picture in folder.rglob("*.png"):
                assert f"../../{picture.relative_to(docs.ROOT).as_posix()}" in pictures


@pytest.mark.parametrize("name", DRAWING)
def test_a_display_that_draws_has_a_picture(name: str) -> None:
    assert f"![{name}](" in GENERATED[docs.page_name(name)]


def said_keys() -> Iterator[tuple[str, str]]:
    """Module and key of each status in the source of the displays."""
    for path in sorted(SOURCES.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text())):
            if not isinstance(node, ast.Call) or not node.args:
                continue
            function = ast.unparse(node.func)
            is_said = re.fullmatch(r"ctx\.(ok|warn|error)|say|\(ctx\.ok if .*", function)
            key = node.args[0]
            if is_said and isinstance(key, ast.Constant) and isinstance(key.value, str):
                yield path.stem, key.value


def test_every_status_is_explained() -> None:
    notes = docs.read_notes()
    explained = {key for each in notes.values() for key in each.statuses}
    texts = list(said_keys())
    assert len(texts) > 30
    assert [(module, key) for module, key in texts if key not in explained] == []


def test_a_property_has_its_bounds_unit_condition_and_default() -> None:
    text = GENERATED["path.md"]
    assert (
        "| Line Width (m) | `line_width` | number ≥ 0.001 | 0.03 | Width of the line. "
        "Where `line_style` is `Billboards`. |"
    ) in text
    assert "| Color | `color` | red, green, blue, 0 to 255 each | [25, 255, 0] |" in text
    assert "| Alpha | `alpha` | number, 0 to 1 | 1 |" in text
    assert "| Pose Style | `pose_style` | `None`, `Axes`, `Arrows` | `None` |" in text


def test_the_readme_is_short_and_begins_with_the_animation_of_the_demo() -> None:
    readme = (docs.ROOT / "README.md").read_text()
    assert readme.count("\n") < 150
    assert docs.ROOT / links(readme)[0] == demo_picture.PATH
    with PIL.Image.open(demo_picture.PATH) as picture:
        assert picture.size == demo_picture.SIZE
        assert getattr(picture, "n_frames", 1) == demo_picture.FRAMES
    assert demo_picture.PATH.stat().st_size < 1_500_000
    command = Path(demo_picture.__file__).relative_to(docs.ROOT)
    assert f"python {command}" in (docs.ROOT / "CONTRIBUTING.md").read_text()

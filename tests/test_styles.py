"""Style sheets: they are found by themselves, and have colours, sizes and shapes from one file."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import pytest

from webviz.server.channel.modules import Modules, styles

ROOT = Path(__file__).parent.parent / "webviz"
TOKENS = ROOT / "page/web/tokens.css"
SHEETS = sorted(path for path in ROOT.rglob("*.css") if path != TOKENS)
COLOR = re.compile(
    r"#(?:[0-9a-f]{3,4}|[0-9a-f]{6}|[0-9a-f]{8})\b(?=[^{]*[;}])|\b(?:rgb|hsl)a?\(", re.I
)
SIZED = re.compile(
    r"(?:padding|margin|border|outline)(?:-\w+)*|(?:row-|column-)?gap|font(?:-size)?|box-shadow"
    r"|transition(?:-duration)?|animation(?:-duration)?"
)
"""Properties whose lengths and durations have names: spacing, lines, shapes, text and motion."""
SIZE = re.compile(r"(?<![\w.-])-?(?:\d*\.)?\d*[1-9]\d*(?:\.\d+)?(?:px|rem|pt|m?s)\b")
CONTRAST = {"#fff", "#000"}
"""Colours on one that comes from a message, which no token knows."""
COMMENT = re.compile(r"^ *(/\*\*|\*|//).*$", re.MULTILINE)
FROM_MODULES = re.compile(r"""["'`](--[\w-]+)["'`]""")


def declarations(path: Path) -> list[tuple[str, str]]:
    """Return the properties of a style sheet and their values."""
    text = re.sub(r"/\*.*?\*/", "", path.read_text("utf-8"), flags=re.DOTALL)
    return re.findall(r"(?<=[{;\s])([\w-]+):\s*([^;{}]+?)\s*(?=[;}])", text)


@pytest.mark.parametrize("path", SHEETS, ids=lambda path: path.name)
def test_colours_stand_in_one_file(path: Path) -> None:
    wrong = [(name, value) for name, value in declarations(path) if COLOR.search(f"{value};")]
    assert not wrong, f"name them in {TOKENS.name}"


@pytest.mark.parametrize("path", SHEETS, ids=lambda path: path.name)
def test_spacing_lines_shapes_text_and_motion_have_names(path: Path) -> None:
    wrong = [
        (name, value)
        for name, value in declarations(path)
        if SIZED.fullmatch(name) and SIZE.search(value)
    ]
    assert not wrong, f"name them in {TOKENS.name}"


def test_a_size_is_found_wherever_it_stands_in_a_value() -> None:
    result = ("8px", "0 -8px", "0.5px auto", "calc(100% - 8px)", "rotate 0.1s", "600 13px/1.4 x")
    assert all(SIZE.search(value) for value in result)
    named = ("0", "0px auto", "var(--wv-space-8)", "50%", "2em", "none", "var(--wv-8px)")
    assert not any(SIZE.search(value) for value in named)


def test_each_token_has_one_value_per_theme() -> None:
    """A colour or size that stands twice would be changed in one place only."""
    text = TOKENS.read_text("utf-8").split("@media")[0]
    blocks = re.findall(r"([^{}]+)\{([^{}]*)\}", re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL))
    names = [
        (at.strip(), name) for at, rules in blocks for name in re.findall(r"--[\w-]+(?=:)", rules)
    ]
    assert not [one for one, count in Counter(names).items() if count > 1]


def test_modules_draw_with_colours_of_the_tokens() -> None:
    literal = re.compile(r"""["'`](#[0-9a-f]{3,8})["'`]""", re.I)
    wrong = {
        (path.name, color)
        for path in ROOT.rglob("*.js")
        for color in literal.findall(COMMENT.sub("", path.read_text("utf-8")))
        if color not in CONTRAST
    }
    assert not wrong


def test_the_tokens_that_style_sheets_use_exist() -> None:
    defined = {name for path in [TOKENS, *SHEETS] for name, _ in declarations(path)}
    for path in ROOT.rglob("*.js"):
        defined.update(FROM_MODULES.findall(path.read_text("utf-8")))
    used = {
        name
        for path in SHEETS
        for name in re.findall(r"var\((--[\w-]+)\)", path.read_text("utf-8"))
    }
    assert used <= defined


def test_no_module_has_rules_in_a_string() -> None:
    rules = re.compile(r"""createElement\(["']style|insertRule|\bstyle\(["'`][\w-]+["'`]""")
    assert not [path for path in ROOT.rglob("*.js") if rules.search(path.read_text("utf-8"))]


def test_all_style_sheets_are_in_the_page_the_common_ones_first() -> None:
    own = [path for path in SHEETS if "panels" not in path.relative_to(ROOT).parts[:1]]
    head = Modules({}).head.decode()
    for path in [TOKENS, *own]:
        assert path.read_text("utf-8") in head, path
    names = ["panels/b.css", "features/a/a.css", "tokens.css", "main.js", "page.css"]
    assert styles(names) == ["page.css", "tokens.css", "panels/b.css", "features/a/a.css"]

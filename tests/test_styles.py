"""Style sheets: they are found by themselves, and have colours, sizes and shapes from one file."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from webviz.server.channel.modules import Modules, styles

ROOT = Path(__file__).parent.parent / "webviz"
TOKENS = ROOT / "page/web/tokens.css"
SHEETS = sorted(path for path in ROOT.rglob("*.css") if path != TOKENS)
COLOR = re.compile(
    r"#(?:[0-9a-f]{3,4}|[0-9a-f]{6}|[0-9a-f]{8})\b(?=[^{]*[;}])|\b(?:rgb|hsl)a?\(", re.I
)
KINDS = {
    "border-radius": ("radius", "round", "pill"),
    "font-size": ("tiny", "small", "large"),
    "box-shadow": ("lift", "lift-alarm", "lift-strong", "shadow"),
    "font": ("mono",),
    "transition": ("fold",),
}
"""Properties, and the tokens that have values for them."""
FROM_MODULES = re.compile(r"""["'`](--[\w-]+)["'`]""")


def declarations(path: Path) -> list[tuple[str, str]]:
    """Return the properties of a style sheet and their values."""
    text = re.sub(r"/\*.*?\*/", "", path.read_text("utf-8"), flags=re.DOTALL)
    return re.findall(r"(?<=[{;\s])([\w-]+):\s*([^;{}]+?)\s*(?=[;}])", text)


def tokens() -> dict[str, set[str]]:
    """Return all values of each token, without the prefix of its name."""
    values: dict[str, set[str]] = {}
    for name, value in declarations(TOKENS):
        values.setdefault(name.removeprefix("--wv-"), set()).add(value)
    return values


@pytest.mark.parametrize("path", SHEETS, ids=lambda path: path.name)
def test_colours_stand_in_one_file(path: Path) -> None:
    wrong = [(name, value) for name, value in declarations(path) if COLOR.search(f"{value};")]
    assert not wrong, f"name them in {TOKENS.name}"


@pytest.mark.parametrize("path", SHEETS, ids=lambda path: path.name)
def test_a_value_that_has_a_name_stands_under_it(path: Path) -> None:
    known = tokens()
    wrong = [
        (property_, value, token)
        for property_, value in declarations(path)
        for token in KINDS.get(property_, ())
        if any(own in value for own in known[token])
    ]
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
    assert {f"--wv-{token}" for tokens_ in KINDS.values() for token in tokens_} <= defined


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

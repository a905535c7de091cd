"""Prints every sentence that webviz's code may show, with its place, to be read aloud.

    python tests/support/sentences.py [FOLDER ...]

Values are written as {...}; docstrings, comments and texts without a verb's room are left out.
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]
FOLDERS = ("webviz", "displays/webviz_displays", "urdf/webviz_urdf", "sim/webviz_sim")
FEWEST_WORDS = 3
SCRIPT = re.compile(r'"((?:[^"\\\n]|\\.)*)"|`((?:[^`\\]|\\.)*)`|^\s*(?://|\*|/\*).*$', re.MULTILINE)
"""Texts in double quotes and templates in JavaScript; comments, so that theirs are not taken."""


class Sentence(NamedTuple):
    """A text and its place."""

    file: str
    line: int
    text: str


def sentences(folders: tuple[str, ...] = FOLDERS) -> Iterator[Sentence]:
    """All texts of at least three words, in the order of files and lines."""
    for folder in folders:
        for path in sorted((ROOT / folder).rglob("*")):
            source = path.read_text(encoding="utf-8") if path.suffix in (".py", ".js") else ""
            result = _in_python(source) if path.suffix == ".py" else _in_script(source)
            for line, text in result:
                text = " ".join(text.split())
                if len(re.findall(r"[A-Za-z][a-z']+", text)) >= FEWEST_WORDS:
                    yield Sentence(str(path.relative_to(ROOT)), line, text)


def _in_python(source: str) -> Iterator[tuple[int, str]]:
    tree = ast.parse(source)
    quiet = {id(part) for node in ast.walk(tree) for part in _unseen(node)}
    for node in ast.walk(tree):
        if id(node) in quiet:
            continue
        if isinstance(node, ast.JoinedStr):
            yield node.lineno, "".join(map(_part, node.values))
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.lineno, node.value


def _unseen(node: ast.AST) -> Iterator[ast.AST]:
    """Docstrings, and the parts of a text that is yielded as a whole."""
    if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
        yield node.value
    if isinstance(node, ast.JoinedStr):
        yield from node.values


def _part(node: ast.expr) -> str:
    return str(node.value) if isinstance(node, ast.Constant) else "{...}"


def _in_script(source: str) -> Iterator[tuple[int, str]]:
    for match in SCRIPT.finditer(source):
        text = match[1] or match[2]
        if text and " " in text:
            yield source.count("\n", 0, match.start()) + 1, re.sub(r"\$\{[^}]*\}", "{...}", text)


if __name__ == "__main__":
    for sentence in sentences(tuple(sys.argv[1:]) or FOLDERS):
        print(f"{sentence.file}:{sentence.line}: {sentence.text}")

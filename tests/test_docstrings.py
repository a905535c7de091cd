"""Mood of docstrings: modules, classes and values get a noun phrase, functions the imperative."""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
FILES = [
    path
    for folder in ("webviz", "displays", "urdf", "sim", "ros", "tests")
    for path in sorted((ROOT / folder).rglob("*.py"))
]
QUESTIONS = ("What", "Whether", "How", "Which")
PAGE = ROOT / "webviz" / "page" / "web"
COMMENT = re.compile(rf"(?:/\*\*[\s*]*|^//)\s*(?:{'|'.join(QUESTIONS)})\b.*", re.MULTILINE)
"""A comment of JSDoc, of a module or at its top level that begins as a question."""


@pytest.mark.parametrize("folder", sorted({path.relative_to(ROOT).parts[0] for path in FILES}))
def test_no_docstring_begins_as_a_question(folder: str) -> None:
    found = [
        f"{path.relative_to(ROOT)}:{node.lineno}: {node.value.value.split(chr(10))[0]}"
        for path in FILES
        if path.relative_to(ROOT).parts[0] == folder
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
        and node.value.value.lstrip().split(" ", 1)[0] in QUESTIONS
    ]
    assert found == []


def test_no_comment_of_the_page_begins_as_a_question() -> None:
    modules = sorted(PAGE.rglob("*.js"))
    assert modules
    found = [
        f"{path.relative_to(ROOT)}: {' '.join(match.group().split())}"
        for path in modules
        for match in COMMENT.finditer(path.read_text(encoding="utf-8"))
    ]
    assert found == []

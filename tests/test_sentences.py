"""Sentences of which one comes from elsewhere do not run together."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from webviz.data.words import joined
from webviz.engine.error_boundary import ErrorBoundary

ROOT = Path(__file__).parents[1]
FILES = [
    path
    for folder in ("webviz", "displays/webviz_displays", "urdf/webviz_urdf", "sim/webviz_sim")
    for path in sorted((ROOT / folder).rglob("*.py"))
]
FOREIGN = re.compile(r"(error|sentence|reason|fault|why|cause|problem|remark)\b")
"""Names of texts that are made elsewhere, and so may lack their full stop."""
NEXT = re.compile(r" [A-Z][a-z']* ")
"""The beginning of another sentence; units such as MB have no small letters or no blank."""


@pytest.mark.parametrize(
    ("texts", "whole"),
    [
        (("It failed: boom", "Press Reset."), "It failed: boom. Press Reset."),
        (("No publisher.", "Start one."), "No publisher. Start one."),
        (("Which?", "This!", "And so on…"), "Which? This! And so on…"),
        (("", "One", " "), "One."),
        ((), ""),
    ],
)
def test_a_sentence_without_an_end_gets_a_full_stop(texts: tuple[str, ...], whole: str) -> None:
    assert joined(*texts) == whole


def test_a_failure_ends_before_its_remedy() -> None:
    boundary = ErrorBoundary("", strict=False)
    boundary("TF", int, "boom")
    text = boundary.statuses()["TF"].text
    assert "literal for int() with base 10: 'boom'. The log has" in text


def test_texts_from_elsewhere_are_joined_by_the_helper() -> None:
    faults = [
        f"{path.relative_to(ROOT)}:{node.lineno}: {ast.unparse(node)}"
        for path in FILES
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.JoinedStr) and any(_run_together(node))
    ]
    assert faults == []


def _run_together(text: ast.JoinedStr) -> Iterator[bool]:
    parts = [*text.values, None]
    for first, blank, second in zip(parts, parts[1:], parts[2:], strict=False):
        if isinstance(first, ast.FormattedValue) and isinstance(blank, ast.Constant):
            is_foreign = FOREIGN.search(ast.unparse(first.value)) is not None
            is_blank = blank.value == " " and second is not None
            yield is_foreign and (is_blank or NEXT.match(str(blank.value)) is not None)

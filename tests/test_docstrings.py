"""Mood of docstrings: modules, classes and values get a noun phrase, functions the imperative."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
WORDS = r"(?:What|Whether|How|Which)\b.*"
DOCSTRING = re.compile(rf'^[ \t]*r?"""\s*{WORDS}', re.MULTILINE)
"""A text between three quotation marks that begins a line."""
COMMENT = re.compile(rf"(?:/\*\*[\s*]*|^//)\s*{WORDS}", re.MULTILINE)
"""A comment of JSDoc, of a module or at its top level."""
PAGE = "webviz/page/web"


@pytest.mark.parametrize(
    ("folder", "pattern"),
    [
        *((name, DOCSTRING) for name in ("webviz", "displays", "urdf", "sim", "ros", "tests")),
        (PAGE, COMMENT),
    ],
)
def test_no_docstring_or_comment_begins_as_a_question(
    folder: str, pattern: re.Pattern[str]
) -> None:
    files = sorted((ROOT / folder).rglob("*.js" if folder == PAGE else "*.py"))
    assert files
    found = [
        f"{path.relative_to(ROOT)}: {' '.join(match.group().split())}"
        for path in files
        for match in pattern.finditer(path.read_text(encoding="utf-8"))
    ]
    assert found == []

"""The code blocks of the documentation."""

from __future__ import annotations

import re
import shlex
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGES = sorted(
    [
        *ROOT.glob("*.md"),
        *(ROOT / "displays/docs").rglob("*.md"),
        ROOT / "tests/benchmarks/README.md",
    ]
)
_BLOCK = re.compile(r'^```(\w+)(?: title="([^"]*)")?\n(.*?)^```', re.MULTILINE | re.DOTALL)


@dataclass(frozen=True)
class Block:
    """A fenced block."""

    page: Path
    line: int
    language: str
    title: str
    """Name of a file, or things that commands need and a test does not have; "" if tests run it."""
    text: str

    def __str__(self) -> str:
        return f"{self.page.relative_to(ROOT)}:{self.line}"

    def commands(self) -> list[tuple[str, ...]]:
        """The words of each command of a block in `sh`."""
        results: list[tuple[str, ...]] = []
        for line in self.text.replace("\\\n", " ").splitlines():
            lexer = shlex.shlex(line, posix=True, punctuation_chars="&")
            lexer.whitespace_split = True
            words: list[str] = []
            for word in [*lexer, "&&"]:
                if word != "&&":
                    words.append(word)
                elif words:
                    results.append(tuple(words))
                    words = []
        return results


def blocks(language: str) -> list[Block]:
    """The blocks in a language, of all pages."""
    results: list[Block] = []
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        for match in _BLOCK.finditer(text):
            line = text.count("\n", 0, match.start()) + 1
            if match[1] == language:
                results.append(Block(page, line, match[1], match[2] or "", match[3]))
    return results


CONFIG = next(block for block in blocks("yaml") if block.page.parent.name == "config")
"""`lab.yaml`, with which the commands and programs of all pages work."""

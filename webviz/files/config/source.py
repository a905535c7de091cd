"""YAML text as values with line numbers.

ruamel.yaml's pure reader is used: a file of 250 displays takes 0.15 s, and its releases no longer
include the reader in C. It reads YAML 1.2: `on` is text, 1e3 and 0x10 are numbers and 12:30
is text.
"""

from __future__ import annotations

import functools
import io
import json
import re
from typing import Any

import msgspec
from ruamel.yaml import YAML
from ruamel.yaml.composer import Composer
from ruamel.yaml.error import YAMLError
from ruamel.yaml.nodes import MappingNode, Node, ScalarNode, SequenceNode

from webviz.files.config.errors import ConfigError

MAX_VALUES = 50_000
"""Values per file; YAML's aliases can expand a few lines without end."""
MAX_CHARACTERS = 4 << 20
"""Characters of all values, including aliases."""
MAX_DIGITS = 1000
"""Of an integer. Python writes none of more than 4300 decimal digits, but reads them as 0xfff…"""
MAX_DEPTH = 64
"""Levels; real files have fewer than 20."""
HALF = "a text contains half of a surrogate pair, such as \\ud800. Remove it."
_HALF = re.compile("[\ud800-\udfff]")
TOO_LONG = f"a number has more than {MAX_DIGITS} digits."
_SAFE = re.compile(r"""(?:[^"']|(["'])(?:<[a-z ]+>|.)\1)*""")
"""Text before the first quotation other than a single character or a kind of token."""

Path = tuple[str | int, ...]
"""Keys and indices from the top of a file."""


class YamlDocument:
    """A YAML document.

    Args:
        text: one document.
        where: names it in errors.

    Raises:
        ConfigError: it is not YAML, or too large or too deep for a config. The sentence does
            not quote the text: the file may be anything.
    """

    def __init__(self, text: str, where: str) -> None:
        self.where = where
        self._yaml = YAML(typ="safe", pure=True)
        self._yaml.Composer = functools.partial(_Composer, where)
        try:
            self.node: Node | None = self._yaml.compose(io.StringIO(text))
        except (YAMLError, ValueError) as error:
            raise self._refused(error) from error
        self._refuse_endless()

    def values(self) -> Any:
        """Return the document as mappings, lists and plain values.

        Raises:
            ConfigError: a value is invalid, such as a date in a month that does not exist.
        """
        if self.node is None:
            return None
        try:
            return self._yaml.constructor.construct_document(self.node)
        except (YAMLError, ValueError, TypeError, OverflowError) as error:
            raise self._refused(error) from error

    def line(self, path: Path) -> int:
        """Return the line of a value, from 1; for a missing value the line of its parent."""
        node, line = self.node, 1
        for step in path:
            if isinstance(node, MappingNode):
                found = [pair for pair in node.value if pair[0].value == step]
                mark, node = found[-1] if found else (None, None)
            elif isinstance(node, SequenceNode) and isinstance(step, int):
                mark = node = node.value[step] if step < len(node.value) else None
            else:
                mark = node = None
            if mark is None:
                break
            line = mark.start_mark.line + 1
        return line

    def _refuse_endless(self) -> None:
        """Refuse documents that aliases make too large or too deep, such as recursive ones."""
        waiting, count, characters = [(self.node, 1)], 0, 0
        while waiting:
            node, depth = waiting.pop()
            count += 1
            if isinstance(node, ScalarNode):
                characters += len(node.value)
                if _HALF.search(node.value):
                    raise ConfigError(f"{self.where}:{node.start_mark.line + 1}: {HALF}")
                if len(node.value) > MAX_DIGITS and node.tag.endswith(":int"):
                    raise ConfigError(f"{self.where}:{node.start_mark.line + 1}: {TOO_LONG}")
            _refuse_too_large(self.where, count, depth, characters)
            if isinstance(node, MappingNode):
                waiting += [(part, depth + 1) for pair in node.value for part in pair]
            elif isinstance(node, SequenceNode):
                waiting += [(part, depth + 1) for part in node.value]

    def _refused(self, error: Exception) -> ConfigError:
        mark = getattr(error, "problem_mark", None)
        place = f"{self.where}:{mark.line + 1}" if mark else self.where
        problem = getattr(error, "problem", None) or (str(error).splitlines() or ["unreadable"])[0]
        if "'\\t'" in problem:
            problem = "found a tab, expected spaces"
        safe = _SAFE.match(problem)
        problem = safe[0].rstrip(" :(") if safe else "unreadable"
        return ConfigError(f"{place} is not valid YAML: {problem}.")


class _Composer(Composer):
    """Stops as soon as a document is too large, instead of reading all of it first."""

    def __init__(self, where: str, loader: Any = None) -> None:
        super().__init__(loader)
        self.warn_double_anchors = False  # which YAML allows
        self._where = where
        self._count = 0

    def compose_node(self, parent: Any, index: Any) -> Any:
        self._count += 1
        _refuse_too_large(self._where, self._count, self.depth)
        return super().compose_node(parent, index)


def _refuse_too_large(where: str, values: int, depth: int, characters: int = 0) -> None:
    if values > MAX_VALUES:
        raise ConfigError(f"{where} contains more than {MAX_VALUES} values, including aliases.")
    if characters > MAX_CHARACTERS:
        raise ConfigError(f"{where} is larger than {MAX_CHARACTERS >> 20} MB, including aliases.")
    if depth > MAX_DEPTH:
        raise ConfigError(f"{where} is nested deeper than {MAX_DEPTH} levels.")


class Location(msgspec.Struct, frozen=True):
    """Where a value stands, for sentences: `lab.yaml:12: displays[2].size`.

    Args:
        path: of the value, from the root of the source.
        source: the file; without one only the path is reported.
    """

    path: Path = ()
    source: YamlDocument | None = None

    def at(self, *path: str | int) -> Location:
        """Return a place below this one."""
        return Location((*self.path, *path), self.source)

    @property
    def line(self) -> int:
        """The line in the file; 0 without a file."""
        return self.source.line(self.path) if self.source else 0

    def words(self) -> str:
        """Return the path: `displays[2].size`."""
        words = ""
        for step in self.path:
            if isinstance(step, str) and step.replace("_", "a").isalnum():
                words += f".{step}" if words else step
            else:
                words += f"[{json.dumps(step, ensure_ascii=False)}]"
        return words

    def says(self, clause: str) -> str:
        """Return a sentence about the value that starts with its place."""
        words = self.words()
        parts = [words, clause] if words else [clause]
        if self.source:
            parts.insert(0, f"{self.source.where}:{self.line}")
        return ": ".join(parts) + ("" if clause.endswith(("?", ".", ":")) else ".")

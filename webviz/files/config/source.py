"""YAML text as values with line numbers."""

from __future__ import annotations

import json
from typing import Any

import msgspec
from ruamel.yaml.nodes import MappingNode, SequenceNode

from webviz.data.plain_yaml import DEFAULTS, YamlDocumentError, YamlNodes
from webviz.files.config.errors import ConfigError

MAX_VALUES = DEFAULTS.values
"""Values per file; YAML's aliases can expand a few lines without end."""
MAX_DEPTH = DEFAULTS.depth
"""Levels; real files have fewer than 20."""

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
        try:
            self._nodes = YamlNodes(text)
        except YamlDocumentError as error:
            raise ConfigError(error.sentence(where)) from error
        self.node = self._nodes.root

    def values(self) -> Any:
        """Return the document as mappings, lists and plain values.

        Raises:
            ConfigError: a value is invalid, such as a date in a month that does not exist.
        """
        try:
            return self._nodes.values()
        except YamlDocumentError as error:
            raise ConfigError(error.sentence(self.where)) from error

    def line(self, path: Path) -> int:
        """Return the line of a value, from 1; for a missing value the line of its parent."""
        node, line = self.node, 1
        for step in path:
            if isinstance(node, MappingNode):
                pairs = [pair for pair in node.value if pair[0].value == step]
                mark, node = pairs[-1] if pairs else (None, None)
            elif isinstance(node, SequenceNode) and isinstance(step, int):
                mark = node = node.value[step] if step < len(node.value) else None
            else:
                mark = node = None
            if mark is None:
                break
            line = mark.start_mark.line + 1
        return line


class Location(msgspec.Struct, frozen=True):
    """Place of a value, for sentences: `lab.yaml:12: displays[2].size`.

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

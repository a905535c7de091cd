"""The only reader of YAML, which bounds what a document unfolds to, and the only writer.

ruamel.yaml's pure reader is used: a file of 250 displays takes 0.15 s, and its releases no longer
include the reader in C. It reads YAML 1.2: `on` is text, 1e3 and 0x10 are numbers and 12:30
is text.

Aliases can unfold a few lines without end, and code in C such as `str` of the result holds the
interpreter's lock meanwhile. So values are counted as often as aliases repeat them, before any
value is made.
"""

from __future__ import annotations

import functools
import io
import re
from typing import Any, NamedTuple

from ruamel.yaml import YAML
from ruamel.yaml.composer import Composer
from ruamel.yaml.error import YAMLError
from ruamel.yaml.events import AliasEvent
from ruamel.yaml.nodes import MappingNode, Node, ScalarNode, SequenceNode
from ruamel.yaml.representer import SafeRepresenter

MAX_DIGITS = 1000
"""Largest number of digits of an integer. Python writes none of more than 4300 decimal digits, but
reads them as 0xfff…"""
HALF = "a text contains half of a surrogate pair, such as \\ud800. Remove it."
ALIASES = "Aliases (*name) are not supported. Write the value out."
TOO_LONG = f"a number has more than {MAX_DIGITS} digits."
_HALF = re.compile("[\ud800-\udfff]")
_SAFE = re.compile(r"""(?:[^"']|(["'])(?:<[a-z ]+>|.)\1)*""")
"""Text before the first quotation other than a single character or a kind of token."""
_TAG = "tag:yaml.org,2002:"
_NAMES = ("null", "bool", "int", "float", "str", "seq", "map", "merge")
_PLAIN = frozenset(f"{_TAG}{name}" for name in _NAMES)
_TIMESTAMP, _TEXT = f"{_TAG}timestamp", f"{_TAG}str"


class YamlLimits(NamedTuple):
    """Limits of a document, aliases included."""

    values: int = 50_000
    """Keys, values, lists and mappings."""
    characters: int = 4 << 20
    """Largest number of characters of the document, and of all its values."""
    depth: int = 64
    """Levels; real files have fewer than 20."""
    has_aliases: bool = True
    """False refuses all aliases."""


DEFAULTS = YamlLimits()


class YamlDocumentError(ValueError):
    """A text cannot be read as YAML.

    Args:
        problem: " is not valid YAML: …." or ": …."; quotes nothing of the text, which may be
            anything.
        line: of the problem, from 1; 0 if it is in no line.
    """

    def __init__(self, problem: str, line: int = 0) -> None:
        super().__init__(problem)
        self.problem = problem
        self.line = line

    def sentence(self, where: str) -> str:
        """Return the error of a text that is called `where`."""
        return f"{where}:{self.line}{self.problem}" if self.line else f"{where}{self.problem}"


class YamlNodes:
    """The nodes of one document, which repeat those of aliases.

    Args:
        text: one document.
        limits: of it.

    Raises:
        YamlDocumentError: it is not YAML, or beyond the limits.
    """

    def __init__(self, text: str, limits: YamlLimits = DEFAULTS) -> None:
        if len(text) > limits.characters:
            raise _too_long(limits)
        self._yaml = YAML(typ="safe", pure=True)
        self._yaml.Composer = functools.partial(_Composer, limits)
        try:
            self.root: Node | None = self._yaml.compose(io.StringIO(text))
        except YamlDocumentError:
            raise
        except (YAMLError, ValueError, RecursionError) as error:
            raise _invalid(error) from error
        _refuse_endless(self.root, limits)

    def values(self) -> Any:
        """Return the document as mappings, lists and plain values, dates and bytes included.

        Raises:
            YamlDocumentError: a value is invalid, such as a date in a month that does not exist.
        """
        if self.root is None:
            return None
        try:
            return self._yaml.constructor.construct_document(self.root)
        except (YAMLError, ValueError, TypeError, OverflowError) as error:
            raise _invalid(error) from error


def read_plain(text: str, limits: YamlLimits = DEFAULTS) -> Any:
    """Return a document as mappings, lists, texts, numbers, booleans and None; dates are text.

    Raises:
        YamlDocumentError: it is not YAML, beyond the limits, or of other types.
    """
    nodes = YamlNodes(text, limits)
    waiting, visited = [nodes.root] if nodes.root else [], set[int]()
    while waiting:
        node = waiting.pop()
        if id(node) in visited:
            continue
        visited.add(id(node))
        if node.tag == _TIMESTAMP:
            node.tag = _TEXT
        keys = [key for key, _ in node.value] if isinstance(node, MappingNode) else []
        if node.tag not in _PLAIN or not all(isinstance(key, ScalarNode) for key in keys):
            raise YamlDocumentError(
                " is not valid YAML: a value has an unsupported type.", node.start_mark.line + 1
            )
        waiting += _parts(node)
    return nodes.values()


def write(
    values: Any,
    *,
    representer: type[SafeRepresenter] = SafeRepresenter,
    flow: bool | None = None,
    width: int = 1 << 20,
    is_sorted: bool = True,
    indent: tuple[int, int, int] | None = None,
) -> str:
    """Return plain values as YAML text.

    Args:
        values: mappings, lists and plain values.
        representer: chooses the style of each value.
        flow: whether mappings and lists are in braces; None: those without others in them.
        width: characters of a line, at which longer texts are broken.
        is_sorted: by key.
        indent: columns of mappings, of lists and of their dashes.
    """
    yaml = YAML(typ="safe", pure=True)
    yaml.Representer = representer
    yaml.default_flow_style = flow
    yaml.width = width
    yaml.sort_base_mapping_type_on_output = is_sorted  # pyright: ignore[reportAttributeAccessIssue]
    if indent is not None:
        mapping, sequence, offset = indent
        yaml.indent(mapping=mapping, sequence=sequence, offset=offset)
    stream = io.StringIO()
    yaml.dump(values, stream)
    return stream.getvalue()


class _Composer(Composer):
    """Stops as soon as a document is too large, instead of reading all of it first."""

    def __init__(self, limits: YamlLimits, loader: Any = None) -> None:
        super().__init__(loader)
        self.warn_double_anchors = False  # which YAML allows
        self._limits = limits
        self._count = 0

    def compose_node(self, parent: Any, index: Any) -> Any:
        self._count += 1
        _refuse_too_large(self._limits, self._count, self.depth)
        if not self._limits.has_aliases and self.parser.check_event(AliasEvent):
            line = self.parser.peek_event().start_mark.line + 1
            raise YamlDocumentError(f": {ALIASES}", line)
        return super().compose_node(parent, index)


def _refuse_endless(root: Node | None, limits: YamlLimits) -> None:
    """Refuse documents that aliases make too large or too deep, such as recursive ones."""
    waiting, count, characters = [(root, 1)], 0, 0
    while waiting:
        node, depth = waiting.pop()
        count += 1
        if isinstance(node, ScalarNode):
            characters += len(node.value)
            if _HALF.search(node.value):
                raise YamlDocumentError(f": {HALF}", node.start_mark.line + 1)
            if len(node.value) > MAX_DIGITS and node.tag.endswith(":int"):
                raise YamlDocumentError(f": {TOO_LONG}", node.start_mark.line + 1)
        _refuse_too_large(limits, count, depth, characters)
        if node is not None:
            waiting += [(part, depth + 1) for part in _parts(node)]


def _parts(node: Node) -> list[Node]:
    if isinstance(node, MappingNode):
        return [part for pair in node.value for part in pair]
    return node.value if isinstance(node, SequenceNode) else []


def _refuse_too_large(limits: YamlLimits, values: int, depth: int, characters: int = 0) -> None:
    if values > limits.values:
        raise YamlDocumentError(f" contains more than {limits.values} values, including aliases.")
    if characters > limits.characters:
        raise _too_long(limits)
    if depth > limits.depth:
        raise YamlDocumentError(f" is nested deeper than {limits.depth} levels.")


def _too_long(limits: YamlLimits) -> YamlDocumentError:
    size = limits.characters
    most = f"{size >> 20} MB" if size >= 1 << 20 else f"{size} characters"
    return YamlDocumentError(f" is larger than {most}, including aliases.")


def _invalid(error: Exception) -> YamlDocumentError:
    mark = getattr(error, "problem_mark", None)
    problem = getattr(error, "problem", None) or (str(error).splitlines() or ["unreadable"])[0]
    if "'\\t'" in problem:
        problem = "found a tab, expected spaces"
    safe = _SAFE.match(problem)
    problem = safe[0].rstrip(" :(") if safe else "unreadable"
    return YamlDocumentError(f" is not valid YAML: {problem}.", mark.line + 1 if mark else 0)

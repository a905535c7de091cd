"""RViz's YAML as trees of mappings, lists and plain values, and their differences.

RViz reads every scalar as text. Here text that has exactly one spelling as a bool, an int or a
float becomes one; other text stays, so that writing restores the file: the state of a
window such as 00001e20 is not a number.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np
from ruamel.yaml.nodes import MappingNode, Node, ScalarNode, SequenceNode

from webviz.data import plain_yaml
from webviz.files.config import ConfigError, YamlDocument
from webviz.files.config.writing import Representer

Tree = dict[str, Any]
Path = tuple[str, ...]
"""Keys from the root of a tree."""

MANAGER = "Visualization Manager"
"""RViz's key for everything but panels and windows."""

_NULL = "tag:yaml.org,2002:null"
_FLOAT_MAX = float(np.finfo(np.float32).max)
_MAX_DIGITS = 18
"""Longer integers stay text: many readers do not support them."""


def parse(source: YamlDocument) -> Any:
    """Return a tree from YAML; the last of duplicate keys counts.

    Raises:
        ConfigError: a key is not a plain word.
    """
    return _built(source.node, source.where)


def _built(node: Node | None, where: str) -> Any:
    if isinstance(node, MappingNode):
        if not all(isinstance(key, ScalarNode) for key, _ in node.value):
            raise ConfigError(f"{where}: a key is not a plain word.")
        return {key.value: _built(value, where) for key, value in node.value}
    if isinstance(node, SequenceNode):
        return [_built(value, where) for value in node.value]
    if node is None or node.tag == _NULL or str(node.ctag) == _NULL:
        return None
    return scalar(node.value)


def scalar(text: str) -> bool | int | float | str:
    """Return the value with exactly this spelling, or the text."""
    if text in ("true", "false"):
        return text == "true"
    for kind in (int, float):
        try:
            value = kind(text) if len(text) <= _MAX_DIGITS + 8 else None
        except ValueError:
            continue
        if value is None or not math.isfinite(value) or repr(value) != text:
            continue
        if kind is float or len(text) <= _MAX_DIGITS:
            return value
    return text


class _Representer(Representer):
    """Writes empty values as RViz does."""


_Representer.add_representer(
    type(None), lambda representer, _: representer.represent_scalar(_NULL, "~")
)


def write(tree: Tree) -> str:
    """Return a tree as YAML text, keys sorted, as RViz writes it."""
    # RViz breaks no lines.
    return plain_yaml.write(_tidied(tree), representer=_Representer, flow=False, indent=(2, 4, 2))


def _tidied(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(key): _tidied(value[key]) for key in sorted(value, key=str)}
    if isinstance(value, list | tuple):
        return [_tidied(each) for each in value]
    return value


def child(tree: Any, *path: str) -> Tree:
    """Return the mapping at a path, an empty one if there is none."""
    for key in path:
        tree = tree.get(key) if isinstance(tree, Mapping) else None
    return dict(tree) if isinstance(tree, Mapping) else {}


def leaves(tree: Any, path: Path = ()) -> Iterator[Path]:
    """Paths of all values except mappings, and of empty mappings."""
    if isinstance(tree, Mapping) and tree:
        for key, value in tree.items():
            yield from leaves(value, (*path, str(key)))
    elif path:
        yield path


def put(tree: Tree, path: Path, value: Any) -> None:
    """Set a value in place; a property that gains children keeps its own value as "Value"."""
    for key in path[:-1]:
        inner = tree.setdefault(key, {})
        if not isinstance(inner, dict):
            inner = tree[key] = {"Value": inner}
        tree = inner
    there = tree.get(path[-1])
    if isinstance(there, dict):
        there.update(value if isinstance(value, dict) else {"Value": value})
    else:
        tree[path[-1]] = value


def is_same(a: Any, b: Any) -> bool:
    """Return whether two values are equal to RViz, which uses single precision."""
    if isinstance(a, bool) or isinstance(b, bool):
        return a is b
    if isinstance(a, int | float) and isinstance(b, int | float):
        if a == b:
            return True
        in_range = abs(a) <= _FLOAT_MAX and abs(b) <= _FLOAT_MAX
        return in_range and bool(np.float32(a) == np.float32(b))
    if isinstance(a, list) and isinstance(b, list):
        return len(a) == len(b) and all(is_same(x, y) for x, y in zip(a, b, strict=True))
    if isinstance(a, Mapping) and isinstance(b, Mapping):
        return a.keys() == b.keys() and all(is_same(a[key], b[key]) for key in a)
    return type(a) is type(b) and a == b


def difference(tree: Tree, basis: Tree) -> Tree:
    """Return the part of a tree that is missing from `basis` or differs there."""
    result: Tree = {}
    for key, value in tree.items():
        if key not in basis:
            result[key] = value
        elif isinstance(value, Mapping) and isinstance(basis[key], Mapping):
            if inner := difference(dict(value), basis[key]):
                result[key] = inner
        elif not is_same(value, basis[key]):
            result[key] = value
    return result


def restored(tree: Tree, original: Any, meant: object, meaning: Callable[[Tree], object]) -> Tree:
    """Return a tree merged with the kept parts of its file.

    A kept value that differs from the tree's is another spelling of it, unless the value has
    changed since: it is used if the tree then still means what is meant.

    Args:
        tree: as written without that file.
        original: the `difference` of the file from it.
        meant: what is to be written.
        meaning: reads a tree.
    """
    tree = _copied(tree)
    others: list[tuple[Path, Any]] = []
    _add_missing(tree, original, (), others)
    # Some are valid only together, such as the parts of a faulty vector.
    for group in [others, *([each] for each in others)] if others else []:
        candidate = _copied(tree)
        for path, value in group:
            _replace(candidate, path, value)
        if _is_either(meaning(candidate), meant, meaning(tree)):
            tree = candidate
        if group is others and tree is candidate:
            break
    return tree


def _is_either(value: object, a: object, b: object) -> bool:
    """Return whether each part of a value is that of `a` or `b`; a missing key counts as None."""
    values = (value, a, b)
    trees = [each for each in values if isinstance(each, Mapping)]
    if not trees or len(trees) + values.count(None) < len(values):
        return value in (a, b)
    parts = [each if isinstance(each, Mapping) else {} for each in values]
    return all(_is_either(*(each.get(key) for each in parts)) for key in set().union(*trees))


def _add_missing(tree: Tree, original: Any, path: Path, others: list[tuple[Path, Any]]) -> None:
    for key, value in original.items() if isinstance(original, Mapping) else ():
        key = str(key)
        if key not in tree:
            tree[key] = _copied(value)
        elif isinstance(tree[key], dict) and isinstance(value, Mapping):
            _add_missing(tree[key], value, (*path, key), others)
        else:
            others.append(((*path, key), value))


def _replace(tree: Tree, path: Path, value: Any) -> None:
    for key in path[:-1]:
        tree = tree[key]
    tree[path[-1]] = value


def _copied(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(key): _copied(each) for key, each in value.items()}
    return [_copied(each) for each in value] if isinstance(value, list) else value

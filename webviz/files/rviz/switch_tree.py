"""Switches of displays, which RViz nests as the displays are in groups."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from webviz.api.group import PATH
from webviz.files.rviz import values
from webviz.files.rviz.tree import Tree
from webviz.files.rviz.values import Unfit

OWN = "Value"
"""Key of a group's own switch."""
MAX_LEVELS = 64


def read(raw: Any) -> dict[str, bool]:
    """Switches by the names of groups and display, joined by `webviz.api.group.PATH`.

    Raises:
        Unfit: it is not a tree of switches.
    """
    if not isinstance(raw, Mapping):
        raise Unfit("expected a switch for each display")
    switches: dict[str, bool] = {}
    _collect(raw, (), switches)
    return switches


def write(switches: Mapping[str, bool]) -> Tree:
    """Return the tree of these switches."""
    tree: Tree = {}
    for path, is_on in switches.items():
        *groups, name = path.split(PATH)
        branch = tree
        for group in groups:
            inner = branch.get(group)
            if not isinstance(inner, dict):
                inner = branch[group] = {OWN: True if inner is None else inner}
            branch = inner
        former = branch.get(name)
        branch[name] = {**former, OWN: is_on} if isinstance(former, dict) else is_on
    return {**tree, OWN: True}


def _collect(raw: Mapping[str, Any], groups: tuple[str, ...], switches: dict[str, bool]) -> None:
    if len(groups) > MAX_LEVELS:
        raise Unfit("nested too deeply")
    for name, entry in raw.items():
        if name == OWN and (not groups or not isinstance(entry, Mapping)):
            continue
        path = (*groups, name)
        is_group = isinstance(entry, Mapping) and OWN not in entry
        switches[PATH.join(path)] = is_group or values.read(values.own_value(entry), bool)
        if isinstance(entry, Mapping):
            _collect(entry, path, switches)

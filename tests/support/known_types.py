"""All message types that webviz knows, by package."""

from __future__ import annotations

from importlib import import_module
from itertools import groupby
from typing import Any

import pytest
from rosbags.typesys import Stores, get_typestore

from webviz.data.messages.definitions import FILES

OURS = [name for name in FILES if "/msg/" in name]
"""Types whose definitions are files of webviz."""
_OF_ROS = get_typestore(Stores.ROS2_JAZZY).fielddefs


def _by_package(names: set[str]) -> dict[str, list[str]]:
    groups = groupby(sorted(names), lambda name: name.split("/")[0])
    return {package: list(group) for package, group in groups}


TYPES = _by_package({*_OF_ROS, *OURS})
ROS_TYPES = _by_package({*_OF_ROS} - {*OURS})
"""Types of ROS's own packages."""


def ros_classes(package: str) -> dict[str, Any]:
    """Return the classes of ROS's own types of a package; skip the test if it is not installed."""
    try:
        module = import_module(f"{package}.msg")
    except ImportError:
        pytest.skip(f"{package} is not installed")
    return {name: getattr(module, name.rpartition("/")[2]) for name in ROS_TYPES[package]}

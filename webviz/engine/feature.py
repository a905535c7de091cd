"""The base class of features: what a viewer can do, each complete in one folder.

    class WhatIf(Feature):
        module = "what_if.js"

        @command(Role.OPERATOR)
        def try_frame(self, frame: str, sender: Sender) -> None:
            \"\"\"Take hold of a static frame.\"\"\"

        @store()
        def what_if(self, argument: str) -> WhatIfStore | None:
            \"\"\"Return the frame that is tried, None without one.\"\"\"

A command is a method. The class of `webviz.commands`, its fields, what a page may send, its role
and the types of the page follow from its signature: this one is `TryFrame(frame)`. Packages, webviz
among them, declare features as entry points of the group `webviz.features`.
"""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, ClassVar

from webviz.api.entry_points import installed
from webviz.api.status import Level, Status
from webviz.engine import commands as engine_commands
from webviz.engine.parts.config import ConfigPart
from webviz.engine.parts.declaring import (
    DeclaredCommand,
    DeclaredStore,
    command,
    commands_of,
    store,
    stores_of,
)
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.parts.panels import PanelsPart
from webviz.engine.parts.part import Part
from webviz.engine.parts.settings import SettingsPart
from webviz.engine.parts.time import TimePart
from webviz.engine.parts.topics import TopicsPart
from webviz.engine.parts.transforms import TransformsPart
from webviz.engine.parts.views import ViewsPart

__all__ = ["Feature", "command", "commands", "features", "store", "stores"]

GROUP = "webviz.features"
PARTS: tuple[type[Part], ...] = (
    DisplaysPart,
    ConfigPart,
    PanelsPart,
    SettingsPart,
    TimePart,
    TopicsPart,
    TransformsPart,
    ViewsPart,
)
"""The parts with commands or stores that every viewer has."""


class Feature(Part):
    """One capability of a viewer: its commands, its stores, and its module of the page."""

    module: ClassVar[str] = ""
    """A JavaScript file beside the class, whose function `install` adds it to the page."""


def features() -> Mapping[str, type[Feature]]:
    """Return all features by name."""
    return loaded()[0]


def broken_features() -> Mapping[str, str]:
    """Return those that cannot be loaded by name, each with the reason."""
    return loaded()[1]


def missing_features() -> Mapping[str, Status]:
    """Return statuses of the same."""
    return {
        f"Feature {name}": Status(Level.WARN, f"{name} is missing: {reason}. Reinstall webviz.")
        for name, reason in broken_features().items()
    }


@functools.cache
def commands() -> Mapping[str, DeclaredCommand]:
    """Return the commands of all parts and features by name."""
    return _united(commands_of)


@functools.cache
def stores() -> Mapping[str, DeclaredStore]:
    """Return the stores of all parts and features by name."""
    return _united(stores_of)


@functools.cache
def texts_of(feature: type[Feature]) -> Mapping[str, str]:
    """Return the modules and style sheets of a feature for the page, by file name.

    Raises:
        OSError, UnicodeDecodeError: one cannot be read.
    """
    if not feature.module:
        return {}
    folder = Path(str(sys.modules[feature.__module__].__file__)).parent
    files = [file for suffix in (".js", ".css") for file in sorted(folder.glob(f"*{suffix}"))]
    return {file.name: file.read_text("utf-8") for file in files}


@functools.cache
def loaded() -> tuple[dict[str, type[Feature]], dict[str, str]]:
    """Return all features by name, and the reasons of those that cannot be loaded."""
    features: dict[str, type[Feature]] = {}
    broken: dict[str, str] = {}
    names_in_use = {
        *engine_commands.__all__,
        *(name for part in PARTS for name in commands_of(part)),
    }
    for point in sorted(installed(GROUP), key=lambda point: point.name):
        try:
            feature = point.load()
            names = {*commands_of(feature), *stores_of(feature)}
            if both := names_in_use & names:
                raise ValueError(f"{', '.join(sorted(both))} exists already")
            texts_of(feature)
            names_in_use |= names
            features[point.name] = feature
        except Exception as error:  # those of other packages may raise anything
            broken[point.name] = f"{point.value} does not load: {type(error).__name__}: {error}"
    return features, broken


def _united(of: Callable[[type[Part]], Mapping[str, Any]]) -> dict[str, Any]:
    return {
        name: each for part in (*PARTS, *features().values()) for name, each in of(part).items()
    }

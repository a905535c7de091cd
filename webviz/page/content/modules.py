"""Modules of plug-ins for the page."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from webviz.api.display import Display
from webviz.api.modules import module_texts
from webviz.api.panel import Panel
from webviz.api.registry import plugin_types
from webviz.api.tool import Tool
from webviz.engine.store import PageStore


class ModulesStore(PageStore, frozen=True):
    """The texts of all modules by kind and name of their plug-ins, such as "tool Lasso".

    Those of a plug-in are by file name, each after those that it imports.
    """

    spread: ClassVar = {"modules": ""}

    modules: Mapping[str, Mapping[str, str]]


def modules() -> ModulesStore:
    """Return the modules of all plug-ins that have one."""
    return ModulesStore(
        {
            f"{base.kind} {name}": module_texts(cls)
            for base in (Display, Tool, Panel)
            for name, cls in plugin_types(base).items()
            if cls.module
        }
    )

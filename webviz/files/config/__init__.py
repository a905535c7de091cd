"""The saved state of a viewer as YAML: settings, and the lists of displays, tools and panels."""

from webviz.files.config.atomic import write_text
from webviz.files.config.errors import ConfigError, nearest
from webviz.files.config.explain import explain, mistakes, sentences
from webviz.files.config.files import is_rviz, read_text
from webviz.files.config.layout import DockedPanel, FloatingPanel, Layout
from webviz.files.config.model import (
    STANDARD,
    VERSION,
    Branch,
    Config,
    Item,
    PanelItem,
    Settings,
    ToolItem,
    Unreadable,
    all_panels,
    all_tools,
    standard,
)
from webviz.files.config.reading import MAX_PLUGINS, read, read_display, read_panel, read_tool
from webviz.files.config.robots import Template
from webviz.files.config.source import MAX_DEPTH, MAX_VALUES, Location, YamlDocument
from webviz.files.config.watch import WatchLimits, WatchRule
from webviz.files.config.writing import document, dump, dump_displays

__all__ = [
    "MAX_DEPTH",
    "MAX_PLUGINS",
    "MAX_VALUES",
    "STANDARD",
    "VERSION",
    "Branch",
    "Config",
    "ConfigError",
    "DockedPanel",
    "FloatingPanel",
    "Item",
    "Layout",
    "Location",
    "PanelItem",
    "Settings",
    "Template",
    "ToolItem",
    "Unreadable",
    "WatchLimits",
    "WatchRule",
    "YamlDocument",
    "all_panels",
    "all_tools",
    "document",
    "dump",
    "dump_displays",
    "explain",
    "is_rviz",
    "mistakes",
    "nearest",
    "read",
    "read_display",
    "read_panel",
    "read_text",
    "read_tool",
    "sentences",
    "standard",
    "write_text",
]

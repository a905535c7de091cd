"""The saved state of a viewer as YAML: fixed frame, background, view, and the list of displays."""

from webviz.config.errors import ConfigError, describe, nearest
from webviz.config.files import is_rviz, read_text, write_text
from webviz.config.model import (
    STANDARD,
    VERSION,
    Branch,
    Config,
    Item,
    Settings,
    Unreadable,
    standard,
)
from webviz.config.reading import MAX_VALUES, load, parse, read_display
from webviz.config.writing import document, dump, save

__all__ = [
    "MAX_VALUES",
    "STANDARD",
    "VERSION",
    "Branch",
    "Config",
    "ConfigError",
    "Item",
    "Settings",
    "Unreadable",
    "describe",
    "document",
    "dump",
    "is_rviz",
    "load",
    "nearest",
    "parse",
    "read_display",
    "read_text",
    "save",
    "standard",
    "write_text",
]

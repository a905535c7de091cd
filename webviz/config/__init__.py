"""The saved state of a viewer as YAML: fixed frame, background, view, and the list of displays."""

from webviz.config.atomic import write_text
from webviz.config.errors import ConfigError, nearest
from webviz.config.explain import explain, mistakes, sentences
from webviz.config.files import is_rviz, read_text
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
from webviz.config.reading import load, parse, read_display
from webviz.config.source import MAX_VALUES, Place, Source
from webviz.config.writing import document, dump, save

__all__ = [
    "MAX_VALUES",
    "STANDARD",
    "VERSION",
    "Branch",
    "Config",
    "ConfigError",
    "Item",
    "Place",
    "Settings",
    "Source",
    "Unreadable",
    "document",
    "dump",
    "explain",
    "is_rviz",
    "load",
    "mistakes",
    "nearest",
    "parse",
    "read_display",
    "read_text",
    "save",
    "sentences",
    "standard",
    "write_text",
]

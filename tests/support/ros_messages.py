"""Messages from nested mappings."""

from webviz.testing.messages import header, message, serialized
from webviz.testing.source import SECOND

__all__ = ["SECOND", "header", "message", "serialized"]

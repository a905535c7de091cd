"""viser's GUI: the panel of a viewer."""

from webviz.edges.gui.control import take_typed
from webviz.edges.gui.panel import Panel

__all__ = ["Panel", "take_typed"]

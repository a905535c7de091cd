"""viser's GUI: the panel of a viewer."""

from webviz.gui.control import take_typed
from webviz.gui.panel import Panel

__all__ = ["Panel", "take_typed"]

"""viser's GUI: the panels of a viewer."""

from webviz.edges.gui.control import take_typed
from webviz.edges.gui.panels import Panels

__all__ = ["Panels", "take_typed"]

"""viser's GUI: the panel of a viewer."""

from webviz.gui.panel import Panel

__all__ = ["Panel"]

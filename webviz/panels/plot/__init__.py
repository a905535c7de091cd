"""The panel Plot: numbers of messages over time."""

from webviz.panels.plot.panel import Plot

__all__ = ["Plot"]

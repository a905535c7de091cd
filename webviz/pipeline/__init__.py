"""From raw messages to nodes and statuses: what runs the displays."""

from webviz.pipeline.background import Workers
from webviz.pipeline.runner import Runner, Services

__all__ = ["Runner", "Services", "Workers"]

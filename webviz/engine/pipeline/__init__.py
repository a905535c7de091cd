"""From raw messages to nodes and statuses: what runs the displays."""

from webviz.engine.pipeline.background import Workers
from webviz.engine.pipeline.runner import Runner, Services

__all__ = ["Runner", "Services", "Workers"]

"""The pipeline of a display, from raw messages to nodes and statuses."""

from webviz.engine.pipeline.background import Workers
from webviz.engine.pipeline.runner import Runner, Services

__all__ = ["Runner", "Services", "Workers"]

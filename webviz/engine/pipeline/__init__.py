"""The pipeline of a display, from raw messages to nodes and statuses."""

from webviz.engine.pipeline.background import Workers
from webviz.engine.pipeline.runner import Runner
from webviz.engine.pipeline.services import Services

__all__ = ["Runner", "Services", "Workers"]

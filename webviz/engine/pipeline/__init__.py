"""The pipeline of a display, from raw messages to nodes and statuses."""

from webviz.engine.pipeline.background import Workers
from webviz.engine.pipeline.runner import Runner
from webviz.engine.pipeline.services import DisplayServices

__all__ = ["DisplayServices", "Runner", "Workers"]

"""From raw messages to nodes and statuses: what runs the displays."""

from webviz.pipeline.runner import Runner

__all__ = ["Runner"]

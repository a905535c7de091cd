"""The frame loop: one thread that owns displays, transforms, scene and state."""

from webviz.engine.loop.loop import FrameLoop

__all__ = ["FrameLoop"]

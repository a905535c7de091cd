"""The parts of a viewer: each owns its commands and its fields of the state."""

from webviz.engine.parts.part import Batches, Core, Handler, Part
from webviz.engine.parts.parts import Parts

__all__ = ["Batches", "Core", "Handler", "Part", "Parts"]

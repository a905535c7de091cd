"""Driving: set-points of browsers become velocity commands, beside the frame loop."""

from webviz.engine.driving.helm import HelmAnswer
from webviz.engine.driving.helms import Helms

__all__ = ["HelmAnswer", "Helms"]

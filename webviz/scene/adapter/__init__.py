"""All calls of viser's private parts; contract tests fail when viser changes them.

Why not public setters: a pose setter ignores moves that `numpy.allclose` considers equal (3 m in
UTM coordinates) and costs ten times as much as queueing its message; two property setters send two
messages, between which a browser may draw.
"""

from webviz.scene.adapter.link import Adapter
from webviz.scene.adapter.poses import Move, Position, Wxyz

__all__ = ["Adapter", "Move", "Position", "Wxyz"]

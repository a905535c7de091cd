"""Constants shared with the modules of the page."""

from __future__ import annotations

from webviz.api.nodes import POINTS_HELD
from webviz.api.views.placement import EYE, FIELD_OF_VIEW, FLAT_FIELD_OF_VIEW, RAISED
from webviz.engine.feature import features
from webviz.scene.capacity import FEWEST_POINTS, MAX_POINTS
from webviz.scene.names import BLOCK_PREFIX, PART_PREFIX, ROOT, TILE_PREFIX
from webviz.scene.points import PART
from webviz.scene.schemes import SCHEMES, TEXT_CODE
from webviz.scene.visual import OPACITY_BIT
from webviz.server.access import rules
from webviz.server.channel.messages import MAX_PANES

DARKEST = 0.3
"""Brightness of a surface seen edge on, as a share of its colour; in RViz it is black."""

CONSTANTS = {
    "ROLES": rules.table(),
    "FEATURES": [
        f"features/{name}/{each.module}" for name, each in features().items() if each.module
    ],
    "ROOT": ROOT,
    "TILE_PREFIX": TILE_PREFIX,
    "PART_PREFIX": PART_PREFIX,
    "BLOCK_PREFIX": BLOCK_PREFIX,
    "POINTS_PER_PART": PART,
    "POINTS_HELD": POINTS_HELD,
    "FEWEST_POINTS": FEWEST_POINTS,
    "MAX_POINTS": MAX_POINTS,
    "MAX_PANES": MAX_PANES,
    "DARKEST": DARKEST,
    "OPACITY_BIT": OPACITY_BIT,
    "SCHEMES": SCHEMES,
    "TEXT_CODE": TEXT_CODE,
    "RAISED": RAISED,
    "EYE": EYE,
    "FIELD_OF_VIEW": FIELD_OF_VIEW,
    "FLAT_FIELD_OF_VIEW": FLAT_FIELD_OF_VIEW,
}

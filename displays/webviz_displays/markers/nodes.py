"""From markers to nodes: those of one look are drawn together."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass, field

from webviz import Node
from webviz_displays.markers.batch import MarkerBatch
from webviz_displays.markers.lines import lines_of, points_of, texts_of
from webviz_displays.markers.meshes import LoadedMesh, mesh_solids, models_of
from webviz_displays.markers.solids import instances_of, solids_of
from webviz_displays.markers.triangles import triangles_of


@dataclass(frozen=True)
class Files:
    """Files used by markers, by the row of the marker in its batch.

    Args:
        meshes: of MESH_RESOURCE; a marker without one is not drawn.
        pictures: PNG or JPEG, of TRIANGLE_LIST.
    """

    meshes: Mapping[int, LoadedMesh] = field(default_factory=dict)
    pictures: Mapping[int, bytes] = field(default_factory=dict)


def nodes_of(batch: MarkerBatch, files: Files = Files()) -> dict[str, Node]:
    """Return the nodes that draw markers, in the coordinates of their group.

    Args:
        batch: such as from `batch_of`; markers that cannot be drawn are left out.
        files: what was loaded.
    """
    solids = itertools.chain(solids_of(batch), mesh_solids(batch, files.meshes))
    return {
        **instances_of(solids),
        **lines_of(batch),
        **points_of(batch),
        **texts_of(batch),
        **triangles_of(batch, files.pictures),
        **models_of(batch, files.meshes),
    }

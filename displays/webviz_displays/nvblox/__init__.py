"""Displays of nvblox: maps of blocks, of which messages bring those that have changed."""

from webviz_displays.nvblox.mesh import NvbloxMesh
from webviz_displays.nvblox.voxels import NvbloxVoxelBlockLayer

__all__ = ["NvbloxMesh", "NvbloxVoxelBlockLayer"]

"""Displays of nvblox: maps of blocks, of which messages bring those that have changed."""

from webviz_displays.nvblox.display import NvbloxMesh, NvbloxVoxelBlockLayer

__all__ = ["NvbloxMesh", "NvbloxVoxelBlockLayer"]

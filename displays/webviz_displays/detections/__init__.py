"""Displays of vision_msgs: boxes around what was detected."""

from webviz_displays.detections.bounding_boxes import BoundingBox3D, BoundingBox3DArray
from webviz_displays.detections.detections import Detection3D, Detection3DArray

__all__ = ["BoundingBox3D", "BoundingBox3DArray", "Detection3D", "Detection3DArray"]

"""The CameraInfo display."""

from webviz_displays.camera_info.display import CameraInfo

__all__ = ["CameraInfo"]

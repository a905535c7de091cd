"""Objects and people that ZED cameras detect."""

from webviz_displays.zed.display import ZedOdDisplay

__all__ = ["ZedOdDisplay"]

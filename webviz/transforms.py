"""tf2's buffer and message filter in Python, which need neither ROS nor the rest of webviz."""

from webviz.data.transforms import *  # noqa: F403
from webviz.data.transforms import __all__ as __all__

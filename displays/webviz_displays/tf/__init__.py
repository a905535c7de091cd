"""The tree of coordinate frames."""

from webviz_displays.tf.display import TF

__all__ = ["TF"]

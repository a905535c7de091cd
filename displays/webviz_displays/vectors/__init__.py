"""Displays of forces, torques, velocities and accelerations."""

from webviz_displays.vectors.effort import Effort
from webviz_displays.vectors.motions import AccelStamped, Twist, TwistStamped
from webviz_displays.vectors.wrench import Wrench

__all__ = ["AccelStamped", "Effort", "Twist", "TwistStamped", "Wrench"]

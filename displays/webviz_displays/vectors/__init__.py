"""Displays of forces, torques, velocities and accelerations."""

from webviz_displays.vectors.accel_stamped import AccelStamped
from webviz_displays.vectors.effort import Effort
from webviz_displays.vectors.twist import Twist
from webviz_displays.vectors.twist_stamped import TwistStamped
from webviz_displays.vectors.wrench import Wrench

__all__ = ["AccelStamped", "Effort", "Twist", "TwistStamped", "Wrench"]

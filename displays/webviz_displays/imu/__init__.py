"""Displays of inertial and magnetic sensors."""

from webviz_displays.imu.imu import Imu
from webviz_displays.imu.mag import Mag

__all__ = ["Imu", "Mag"]

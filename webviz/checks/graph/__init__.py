"""Checks of the ROS graph: who publishes what, and how."""

"""Checks of this machine: variables, ROS and its middleware."""

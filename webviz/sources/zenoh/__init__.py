"""Robots over Zenoh, ROS's own engine for fleets and clouds, without ROS on this machine."""

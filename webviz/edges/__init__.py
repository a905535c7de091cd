"""Where webviz meets other systems: ROS, the scene and the panel of the page."""

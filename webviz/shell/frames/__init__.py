"""The tree of transforms without a page: read from the ROS graph or a bag, and drawn."""

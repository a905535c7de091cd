"""Messages in Foxglove's own schemas, as the equal ones of ROS."""

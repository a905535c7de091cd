"""Messages, transforms and the disk, without ROS."""

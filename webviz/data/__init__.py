"""Messages, recordings, transforms and the disk, without ROS."""

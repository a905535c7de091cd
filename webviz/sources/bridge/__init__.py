"""Live topics through a bridge: one TCP connection, without ROS on this machine."""

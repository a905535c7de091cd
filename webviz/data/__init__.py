"""Messages and transforms without ROS: decoding, encoding, tf2's buffer."""

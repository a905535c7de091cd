"""What messages and transforms are, without ROS: decoding, encoding, tf2's buffer."""

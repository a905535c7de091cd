"""The ROS edge: the only place, besides the simulator, where rclpy is imported."""

"""Everything that imports rclpy, besides the simulator."""

"""The doctor without a page: examines the ROS graph or a bag, and reports its findings."""

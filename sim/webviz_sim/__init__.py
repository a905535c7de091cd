"""A kinematic robot in a small building, which publishes what a TurtleBot with Nav2 would."""

"""Runs the simulator: `python -m webviz_sim`."""

import os
import sys

from webviz_sim.node import main

status = main()
sys.stdout.flush()
sys.stderr.flush()
# Nothing is held any more, and to take the interpreter apart with ROS in it can take seconds.
os._exit(status)

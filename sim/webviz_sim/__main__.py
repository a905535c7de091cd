"""Entry point of the simulator: `python -m webviz_sim`."""

import os
import sys

from webviz_sim.node import main

status = main()
sys.stdout.flush()
sys.stderr.flush()
# Everything is closed; finalising an interpreter with ROS in it can take seconds.
os._exit(status)

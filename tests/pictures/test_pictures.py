"""The pictures themselves can fail, and each shows something of its own."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from pathlib import Path

import building
import numpy as np
import PIL.Image
import pytest
from pictures import REFERENCES, TOLERANCE, Stage, Studio, load, share_of_difference, turned
from robots import DEMO, place_links
from test_robot_model import ROBOTS
from webviz_sim.pose import Pose

from webviz import Display
from webviz.config import View
from webviz_displays.axes import Axes
from webviz_displays.grid import Grid
from webviz_displays.laser_scan import LaserScan
from webviz_displays.map import Map
from webviz_displays.odometry import Odometry
from webviz_displays.path import Path as PathDisplay
from webviz_displays.robot_model import RobotModel
from webviz_displays.tf import TF

FOLDERS = sorted(path for path in REFERENCES.iterdir() if path.is_dir())
EVERYTHING: tuple[type[Display], ...] = (
    Grid,
    Axes,
    TF,
    Map,
    RobotModel,
    LaserScan,
    PathDisplay,
    Odometry,
)

"""Runs the simulator: `python -m webviz_sim`."""

from webviz_sim.node import main

raise SystemExit(main())

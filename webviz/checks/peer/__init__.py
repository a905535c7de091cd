"""Causes between two machines, which `webviz doctor --peer` compares."""

"""The doctor: observes the viewer, runs the checks a few at a time, and orders their findings."""

from webviz.engine.doctor.doctor import Doctor

__all__ = ["Doctor"]

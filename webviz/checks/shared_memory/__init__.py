"""Checks of the shared memory that the middleware uses."""

"""Checks of browsers and of the viewer that serves them."""

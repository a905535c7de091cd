"""Checks of clocks and stamps."""

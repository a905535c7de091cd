"""Checks of transforms: frames that are missing, contradictory, late or wrong."""

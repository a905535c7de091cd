"""Checks of the properties of displays that hide what they show."""

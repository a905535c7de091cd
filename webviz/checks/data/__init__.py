"""Checks of the content of messages."""

"""The frame loop and what it keeps: sources, displays at work, settings, views."""

"""Panels that are added on request; each is a plug-in like any other."""

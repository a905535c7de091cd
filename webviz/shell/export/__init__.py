"""A run as one file: an HTML page with the recorded messages of the scene and of the panels."""

"""A recorded past as a source."""

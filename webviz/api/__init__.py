"""The API of plug-ins: properties, displays, nodes, samples, statuses, views."""

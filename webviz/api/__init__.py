"""What plug-ins are made of: properties, displays, nodes, samples, statuses, views."""

"""The doctor's own checks: one module for each, in folders by level of causes."""

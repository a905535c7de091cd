"""Bug reports: making them in a terminal, opening them, and tests of them."""

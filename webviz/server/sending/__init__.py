"""Order and amount of the messages sent to each browser."""

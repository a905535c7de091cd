"""The program that runs in a browser beside viser's page, and the channel to it."""

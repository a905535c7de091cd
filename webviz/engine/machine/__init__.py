"""This machine, as the doctor, its command and reports look at it."""

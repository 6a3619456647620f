"""The improved generator: regression on the whole scene along the way, with its timing."""

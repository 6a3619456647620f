"""Gaussian mixtures seen from every frame: how they are fitted, and what they say at each time."""

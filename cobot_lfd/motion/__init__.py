"""Paths to trajectories: joint paths, limits and timing."""

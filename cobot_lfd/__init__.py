"""Planar learning and motion for a cobot, as plain values and functions."""

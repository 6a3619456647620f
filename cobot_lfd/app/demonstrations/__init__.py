"""Demonstrations on disk: their files, their care, their quality, and their way to other programs."""

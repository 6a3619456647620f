"""Pictures to frames."""

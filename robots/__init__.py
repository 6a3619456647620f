"""The arms: their descriptions, and the arm in the simulation."""

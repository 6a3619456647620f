"""Evaluation: a plan first, then a result per episode, whatever happens to the rest."""

"""Task-parameterised Gaussian mixtures: paths and frames to a model, a model and new frames to a path."""

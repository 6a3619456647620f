"""The paper's generator: the frames' Gaussians and rings in a new scene, multiplied."""

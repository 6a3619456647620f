"""The scenes: their descriptions, the world built from them, the success checks."""

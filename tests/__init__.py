"""The tests: each name is a statement that must be true."""

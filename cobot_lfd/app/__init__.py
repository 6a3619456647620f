"""The only part that sees everything: recording, pipeline, evaluation, command line."""

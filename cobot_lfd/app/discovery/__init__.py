"""Frames found in demonstrations alone: from their pictures and paths, without a list of objects."""

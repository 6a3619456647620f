"""Methods to compare with: each takes the same demonstrations and frames as ours."""

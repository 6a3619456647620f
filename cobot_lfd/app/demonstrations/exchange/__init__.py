"""Demonstrations from elsewhere and for elsewhere: other file layouts, read and written."""

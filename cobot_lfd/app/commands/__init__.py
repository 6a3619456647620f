"""The commands, a file each: call a library function, print what came of it, return the exit code."""

"""Made-up tasks, public data, and the cases on which methods are compared."""

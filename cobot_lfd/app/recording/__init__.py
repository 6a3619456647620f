"""Recording: hands that lead the arm, and what is kept of it."""

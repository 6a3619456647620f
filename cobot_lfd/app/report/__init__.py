"""Reports: what an evaluation says, for people (HTML, Markdown) and for programs (CSV, JSON)."""

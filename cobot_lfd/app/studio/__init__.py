"""The recording studio: a page in a browser where a person drags the arm through the task."""

"""What does a script state? A case composed in Python, and the file that it makes."""

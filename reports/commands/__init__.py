"""The command ``alula``: one file a command, and how the program ends."""

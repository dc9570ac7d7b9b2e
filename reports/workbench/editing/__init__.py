"""What does a change on the page make of the text of a case? Edits by path, operations on the linkage, undo."""

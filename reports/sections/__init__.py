"""What a reader is told, one file a feature: each makes a section from a result, and no section solves."""

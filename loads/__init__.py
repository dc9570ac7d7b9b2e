"""What acts on the linkage: the case file, statics, weight, pin pressure."""

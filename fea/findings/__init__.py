"""What does a report tell besides what was asked for? It is found here, once; reports tell it and solve nothing."""

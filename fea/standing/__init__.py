"""What a linkage bears in its pose: joint forces of every load case, with friction, thrust and what pins leave open."""

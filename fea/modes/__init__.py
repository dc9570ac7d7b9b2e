"""The ways in which eyes, walls, notches, slots and connections end, each with its formulas: what is borne by mode."""

"""How pins stand in their holes between layers, and what that makes of forces and displacements."""

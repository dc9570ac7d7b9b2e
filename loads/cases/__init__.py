"""The built-in cases, as package data."""

"""Templates of the HTML report, as package data."""

"""What a person needs to see: console, HTML, JSON, figures, VTU."""

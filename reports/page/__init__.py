"""What is written to the disk: the output folder, ``report.html``, its pictures, VTU files."""

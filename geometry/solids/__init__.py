"""Links as solids of the geometry kernel: built or read, with loaded patches, cut across, searched for sharp edges.

Hands on ``Solid``. What is here runs in the kernel's child process.
"""

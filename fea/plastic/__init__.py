"""What load does a ductile link bear? Small-strain plasticity on its solid.

Gives the factor on its loads at which it collapses, the plastic strain on the way there, and what stays after
unloading.
"""

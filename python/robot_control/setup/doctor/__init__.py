"""doctor.py: what of this machine keeps the loop from its deadlines, or the nodes from each other."""

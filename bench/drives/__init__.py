"""Drives without faults: their figures, and the claim that no safety condition reports a fault."""

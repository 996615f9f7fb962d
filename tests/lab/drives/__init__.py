"""Drives without faults: what they reach, and that no safety condition reports one."""

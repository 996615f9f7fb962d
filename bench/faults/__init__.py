"""Random sequences of faults, carried out and judged."""

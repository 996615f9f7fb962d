"""The running robot: what it reports, and the way to command it."""

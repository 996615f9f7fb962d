"""The closed loop in one process, its estimator for recorded data, and the names of its roles and signals."""

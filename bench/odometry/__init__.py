"""Measures the accuracy of odometry on simulated robots with the errors of real ones."""

"""The demonstration: starts a simulated robot, drives it, judges and draws its log."""

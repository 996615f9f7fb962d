"""Trials of the fleet's client: order rules against a model, orders on a simulated robot, losses of the link."""

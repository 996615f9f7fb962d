"""What the fleet client promises: order rules against a model, orders on a simulated robot, losses of the link."""

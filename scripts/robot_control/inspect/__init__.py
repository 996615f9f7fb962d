"""inspect_robot.py: what a robot description means for this package, as a report and a picture."""

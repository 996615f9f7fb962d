"""inspect_robot.py reports how this package understands a robot description, as text and as a picture."""

"""console.py: the robot in a browser: see, drive and understand it."""

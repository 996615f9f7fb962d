"""vda5050.py: a fleet's master commands the robot over VDA 5050; fleet_master.py: a small master."""

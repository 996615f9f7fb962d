"""identify.py: inertia, friction and delay of the wheels from a drive, and gains for them."""

"""identify.py: motor constant, friction, inertia and delay of the wheels from a drive, and gains for them."""

"""A console beside a running robot, a browser without a screen, and a bad link between them."""

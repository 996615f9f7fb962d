"""view_markers.py: what RViz shows beside model and odometry."""

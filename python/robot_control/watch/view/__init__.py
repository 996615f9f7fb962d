"""view_markers.py shows markers in RViz beside model and odometry."""

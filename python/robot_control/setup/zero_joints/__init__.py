"""zero_joints.py: the zeros and the signs of joints, by hand and in a known posture."""

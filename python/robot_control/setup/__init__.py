"""Programs that check, identify and calibrate a robot and its computer."""

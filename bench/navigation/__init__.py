"""Maps, localisation and drives to goals, judged against the simulated truth in virtual time."""

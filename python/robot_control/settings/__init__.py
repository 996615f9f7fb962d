"""Settings in YAML: their layers, their checks, their errors."""

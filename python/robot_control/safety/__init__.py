"""Evaluates safety_status for programs that send commands."""

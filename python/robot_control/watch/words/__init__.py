"""Texts for people in another language than English."""

"""Checks with the shipped senders in virtual time whether anything moves without a release."""

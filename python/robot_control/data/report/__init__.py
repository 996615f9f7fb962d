"""report.py: a log as one page that opens without a network, and a verdict against budgets."""

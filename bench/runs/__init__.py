"""Runs many seeds with the processes of this machine, or with the workers of a Dask cluster."""

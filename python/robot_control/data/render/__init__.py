"""scripts/render: pictures of a run."""

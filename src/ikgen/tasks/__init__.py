"""What of a pose counts: one row a task, found by name."""

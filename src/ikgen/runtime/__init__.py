"""Code that emitted modules carry along, written once for every arm; it imports nothing of ikgen else."""

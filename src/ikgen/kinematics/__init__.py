"""From the chain of a file to exact modified Denavit-Hartenberg rows, and its family."""

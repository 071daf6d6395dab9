"""From a solution graph to a Program: one lowering for every language."""

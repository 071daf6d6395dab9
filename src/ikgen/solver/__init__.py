"""The behavior tree over rule-based leaves."""

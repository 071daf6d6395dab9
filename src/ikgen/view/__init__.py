"""The arm in a browser: a target to drag, and all its solutions."""

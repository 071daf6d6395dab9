"""Reader of xacro files."""

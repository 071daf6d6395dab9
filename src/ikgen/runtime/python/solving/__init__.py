"""All rows of a pose, of many, along a path; the nearest pose that an arm can take."""

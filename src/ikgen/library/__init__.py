"""ikgen as a library: robots in, arms that solve out; nothing is written but the cache."""

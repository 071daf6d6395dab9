"""Reader of DH tables."""

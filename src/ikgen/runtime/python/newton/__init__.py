"""Newton's method on the chain, of one row and of many at once."""

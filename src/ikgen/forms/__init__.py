"""Solution forms, one file each: pattern, branches, conditions, values, lowering and formula."""

"""Matrix equations of a chain, and what is known and unknown in them."""

"""What callers hand over: poses, joint values, and what is wrong with them."""

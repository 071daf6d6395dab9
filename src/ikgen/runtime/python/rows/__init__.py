"""Rows of joint values: which are the same, where they are placed, how they are named and ordered."""

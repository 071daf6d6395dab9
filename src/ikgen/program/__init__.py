"""The Program: typed statements that every language is written from."""

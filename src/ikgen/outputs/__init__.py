"""Files in the user's folder: put there whole, known again, and never another's."""

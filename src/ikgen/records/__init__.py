"""What was asked for and what was made, as data: requests, records of outputs, and their one spelling."""

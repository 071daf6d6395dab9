"""From a request to a closed form: reading, choices, and what helps where there is none."""

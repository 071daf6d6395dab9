"""What runs emitted code, one module a language."""

"""The command line: options in, one job of the library, a summary and an exit code out."""

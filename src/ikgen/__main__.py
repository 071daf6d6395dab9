"""`python -m ikgen`."""

from ikgen.cli.main import main

main()

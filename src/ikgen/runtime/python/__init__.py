"""What the emitted Python module consists of besides its arm's numbers and closed form.

NumPy and the standard library only. `ikgen.emit.python.bundle` copies what a module uses into it.
"""

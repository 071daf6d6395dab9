"""From a joint tree to the serial chain that someone wants solved."""

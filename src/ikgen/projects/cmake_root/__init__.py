"""What the entry point `cmake.root` names: `find_package(ikgen)` finds `cmake/` below it."""

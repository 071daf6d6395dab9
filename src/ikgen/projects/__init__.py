"""Generation as a build step: records of what was made, configs, incremental builds, CMake."""

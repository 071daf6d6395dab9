"""A robot package: `hatch_robot.arm_ik` is generated when the package is built."""

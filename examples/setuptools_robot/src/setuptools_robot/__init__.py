"""A robot package: `setuptools_robot.arm_ik` is generated when the package is built."""

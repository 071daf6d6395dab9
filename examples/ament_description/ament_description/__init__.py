"""A robot description: `ament_description.arm_ik` solves its inverse kinematics."""

"""Emitted code against forward kinematics of the original description."""

"""ikgen: verified, closed-form inverse kinematics code from a robot description."""

__version__ = "0.1.0"

"""A task of ikgen: where the tip is in the base's x-y plane, as planar arms of two joints can reach."""

from ikgen.tasks import Task

PLANE = Task("plane", frozenset({"px", "py"}), 2, "position in the base's x-y plane")

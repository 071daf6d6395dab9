"""The spaces of ikgen's own tasks, by name."""

from __future__ import annotations

from ikgen.tasks import TASKS
from ikgen.verify.task_space import task_space

TASK_SPACES = {task.name: task_space(task) for task in TASKS}

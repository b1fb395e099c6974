"""What the user reads instead of a traceback."""
from __future__ import annotations


class Problem(Exception):
    """Something that the user can put right. The text names the property, its value, the constraint and what
    to do."""


class Cancelled(Exception):
    """The user has ended the job."""

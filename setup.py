"""Lists the packages below ``alula``, which no list in ``pyproject.toml`` has to repeat then; it states all else."""

from setuptools import find_namespace_packages, setup

ROOMS = ("geometry", "loads", "fea", "reports")

setup(
    packages=[
        "alula",
        *(f"alula.{name}" for room in ROOMS for name in find_namespace_packages(include=[room, f"{room}.*"])),
    ]
)

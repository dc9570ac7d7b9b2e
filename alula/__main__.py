"""``python -m alula`` is the command."""

from alula.reports.commands.cli import main

if __name__ == "__main__":
    main()

"""Why a result is as it is; ``alula.loads.text.reason`` has it below, for what loads leave out as well."""

from alula.loads.text.reason import Reason, reason, together, under_load_cases

__all__ = ["Reason", "reason", "together", "under_load_cases"]

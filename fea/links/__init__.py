"""Each link cut free: what it bears by hand and as a solid, and which of the two decides.

Hands on ``LinkByHand``, ``DecidedLink`` and ``SolidResult``.
"""

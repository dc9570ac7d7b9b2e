"""Kinds of joints in one record each, as a contributor would add them."""

from alula.geometry.joints.joint_kinds import ALL_WAYS, MOVES, JointKind, Surface, Way

COLLAR = JointKind(name="collar", bears=ALL_WAYS - {Way.ALONG, Way.ABOUT_ALONG}, rubs=Surface.GUIDE)
"""A sleeve on a round rod: a slider that turns about its guide."""
BALL = JointKind(name="ball", bears=frozenset(MOVES), rubs=Surface.BORE)
"""A rod end: it turns about all axes."""
WELD = JointKind(name="weld", bears=ALL_WAYS, rubs=Surface.BORE)
"""It keeps the angle that the case states."""
MADE = (COLLAR, BALL, WELD)

"""What friction at the joints needs of a case."""

from geometry.base.errors import CaseError
from loads.case.core import CoreCase


def rubbing_joints(case: CoreCase) -> tuple[str, ...]:
    """Return the joints with friction.

    Parameters
    ----------
    case : CoreCase

    Returns
    -------
    tuple of str
    """
    return tuple(name for name, joint in case.joints.items() if joint.friction > 0.0)


def check_friction(case: CoreCase) -> None:
    """Check that friction has what it follows from: a pin's diameter, a joint that moves, a direction.

    Parameters
    ----------
    case : CoreCase

    Raises
    ------
    CaseError
        For the first rule that is broken.
    """
    for name, joint in case.joints.items():
        if joint.guide_length is not None and joint.type != "slider":
            raise CaseError(f"joints.{name}.guide_length: joint {name} is no slider and has no guide; leave it out")
    rubbing = rubbing_joints(case)
    for name in rubbing:
        entry, joint = f"joints.{name}.friction: it is {case.joints[name].friction:g}", case.joints[name]
        if joint.type == "revolute" and joint.pin_diameter is None:
            raise CaseError(
                f"{entry}, but the torque of friction needs the radius of the pin; add joints.{name}.pin_diameter"
            )
        if joint.bonded or (case.joint_model == "bonded" and joint.type == "revolute"):
            raise CaseError(f"{entry}, but a bonded joint does not turn; leave friction out, or do not bond it")
        if case.pose.equilibrium:
            raise CaseError(
                f"{entry}, with which a linkage that is let go stops anywhere about its balance; leave friction out, "
                "or pose.equilibrium"
            )
        if case.drive is None or case.pose.coordinate is None:
            raise CaseError(f"{entry}, but friction opposes a motion and nothing drives this linkage; leave it out")
    for name in case.load_cases if rubbing else ():
        for way in ("forward", "backward"):
            if f"{name} {way}" in case.load_cases:
                raise CaseError(
                    f"load_cases.{name} {way}: with friction, load case '{name}' in one direction has this name as "
                    "well; rename it"
                )

"""What a joint may state of its pin's holes: which entries go together."""

from collections.abc import Mapping

from alula.geometry.base.errors import CaseError
from alula.geometry.joints.fits import RUNNING, fit
from alula.geometry.joints.heads import Heads
from alula.geometry.joints.holes import by_link, largest_clearance, loose_links
from alula.geometry.joints.joint import Joint
from alula.geometry.joints.pin_entries import PRESS, RUNS


def check_holes(name: str, joint: Joint) -> None:
    """Check that what a joint states of its pin's holes fits together.

    Parameters
    ----------
    name : str
        Of the joint.
    joint : Joint

    Raises
    ------
    CaseError
        For the first rule that is broken.
    """
    entry = f"joints.{name}"
    for key, stated in (("clearance", joint.clearance), ("fit", joint.fit)):
        if isinstance(stated, Mapping):
            _check_table(f"{entry}.{key}", joint, stated)
    if joint.fit is not None:
        _check_fits(f"{entry}.fit", joint)
    if not joint.bonded:
        _check_apart(entry, joint)
    if joint.heads is not None:
        _check_heads(f"{entry}.heads", joint, joint.heads)


def _check_table(entry: str, joint: Joint, stated: Mapping[str, object]) -> None:
    """Refuse a table of links where there are no two holes, and a link that the joint does not have."""
    if joint.slides:
        raise CaseError(
            f"{entry}: a joint of type {joint.type} has no two holes; state one clearance for it, or leave it out"
        )
    for link in stated:
        if link not in joint.links:
            raise CaseError(f"{entry}: '{link}' is no link of this joint; choose one of {', '.join(joint.links)}")


def _check_fits(entry: str, joint: Joint) -> None:
    """Refuse fits that there are not, and those of a joint without holes or without a pin's diameter."""
    first, second = joint.links
    if joint.slides:
        raise CaseError(
            f"{entry}: a joint of type {joint.type} has no fit; leave it out, or state the clearance of a pin in a slot"
        )
    if joint.bonded:
        raise CaseError(
            f"{entry}: a bonded joint does not turn, so its pin has no fit; leave it out, or do not bond it"
        )
    if joint.fit == PRESS:
        raise CaseError(
            f'{entry}: it does not say in which link the pin is pressed; write fit = {{ {first} = "{PRESS}" }} or '
            f'fit = {{ {second} = "{PRESS}" }}'
        )
    codes = joint.fit if isinstance(joint.fit, Mapping) else {"": joint.fit or RUNS}
    if len(codes) == 2 and set(codes.values()) == {PRESS}:
        raise CaseError(
            f"{entry}: a pin that is pressed in both links does not let the joint turn; state bonded = true in its "
            "place, or another fit in one of them"
        )
    for link, code in codes.items():
        if code == PRESS:
            if set(joint.tight_in) == set(joint.links):
                other = second if link == first else first
                raise CaseError(
                    f"{entry}: the pin is pressed in '{link}', but tight_in says that it is tight in '{other}'; leave "
                    "out one of the two"
                )
            continue
        if joint.pin_diameter is None:
            raise CaseError(
                f'{entry}: a fit such as "{RUNNING}" needs the diameter of the pin; add pin_diameter, or state a '
                "clearance"
            )
        try:
            fit(RUNNING if code == RUNS else code, joint.pin_diameter)
        except CaseError as error:
            raise CaseError(f"{entry}{'.' * bool(link)}{link}: it is '{code}', but {error}") from None


def _check_apart(entry: str, joint: Joint) -> None:
    """Refuse two statements on one hole, and play where the pin is tight."""
    stated = {"clearance": joint.clearance, "fit": joint.fit}
    tables = {key: found for key, found in stated.items() if isinstance(found, Mapping)}
    plain = [key for key, found in stated.items() if found is not None and key not in tables]
    own, loose = by_link(joint), loose_links(joint)
    for link in joint.links:
        if len([*(key for key in tables if link in tables[key]), *(plain if link in loose else [])]) > 1:
            raise CaseError(
                f"{entry}.fit: fit and clearance both state the hole of '{link}'; leave out one of the two, or state "
                "each for a link of its own"
            )
        if link in own and link not in loose and own[link][1][1] > 0.0:
            key = "fit" if link in tables.get("fit", ()) else "clearance"
            raise CaseError(
                f"{entry}.{key}.{link}: it gives the pin play, but tight_in says that it is tight there; leave out one "
                "of the two"
            )
    if plain and not loose and largest_clearance(joint) > 0.0:
        raise CaseError(
            f"{entry}.{plain[0]}: it gives the pin play, but tight_in says that it is tight in every link; leave out "
            "one of the two"
        )


def _check_heads(entry: str, joint: Joint, heads: Heads) -> None:
    """Refuse heads of a pin that does not turn in two holes, and those that would fall through one."""
    if not joint.pivots:
        kind = "bonded joint" if joint.fixed else f"joint of type {joint.type}"
        raise CaseError(f"{entry}: a {kind} has no pin that turns in two holes, so heads hold none; leave them out")
    hole = (joint.pin_diameter or 0.0) + largest_clearance(joint)
    if heads.diameter <= hole:
        wide = joint.clearance is not None and heads.diameter > (joint.pin_diameter or 0.0)
        smaller = f"{entry.removesuffix('heads')}{'clearance' if wide else 'pin_diameter'}"
        raise CaseError(
            f"{entry}.diameter: it is {heads.diameter:g} mm, but must be larger than the hole, {hole:g} mm; make it "
            f"larger, or {smaller} smaller"
        )
    if heads.gap_ends[1] >= heads.diameter:
        raise CaseError(
            f"{entry}.gap: it is {heads.gap_ends[1]:g} mm, but must stay below the diameter of the heads, "
            f"{heads.diameter:g} mm; make it smaller, or leave heads out"
        )

"""What the verdict of a report does not cover, from what ran and from what the case states."""

import math
from collections.abc import Iterable

from fea.common.verdict import LINKAGE, Quantity, Subject
from fea.outcomes.result import CheckResult, LinkResult
from reports.words.wording import joined

STACKING = (
    "All links lie in one plane. In a real linkage they are stacked along the pins, and the offset bends and twists "
    "them."
)
IMPACT = "A blow loads a link more than the same load at rest."


def not_covered(result: CheckResult) -> tuple[tuple[str, str], ...]:
    """Return (title, text) of everything that the models of this check leave out."""
    moves = result.case.motion is not None
    return (
        ("Other poses", "One pose was checked. Another pose of the linkage may load a link more"
         + ("; alula envelope goes through those of its motion." if moves else ".")),
        ("Stacking", STACKING),
        ("Pins and contact", _pins(result)),
        ("Fatigue", "The loads act once and stay. Loads that come and go break parts at lower stresses"
         + ("; alula envelope counts the cycles of the motion." if moves else ".")),
        ("Creep, temperature, moisture, ageing", _conditions(result)),
        ("Large displacements", _large_displacement(result)),
        ("Buckling", _buckling(result)),
        ("Impact", IMPACT),
        ("Making and scatter", _scatter(result)),
        ("Bands", _bands(result)),
    )  # fmt: skip


def _pins(result: CheckResult) -> str:
    checked = list(dict.fromkeys(joint for case in result.load_cases.values() for joint in case.pins))
    own = (
        f"Of the pins themselves, {joined(checked)} {_was(checked)} checked" if checked else "No pin itself was checked"
    )
    return f"A pin is a pressure on its hole. Clearance, friction and wear are left out. {own}."


def _conditions(result: CheckResult) -> str:
    stated = result.case.conditions
    if stated.duration is None and stated.temperature is None:
        held = "the material values are short-term ones at room temperature, since the case states no conditions"
    elif stated.temperature is None:
        held = "stiffness and stress are judged after the stated time under load, at room temperature"
    elif stated.duration is None:
        held = "the strengths are those at the stated temperature, under short-term load; the modulus is not warmed"
    else:
        held = "strengths are those at the stated temperature, stiffness that after the stated time, not warmed"
    return (
        "Plastics lose strength and stiffness under load that lasts, in warmth and with the years; "
        f"{held}. Moisture and ageing are left out."
    )


def _large_displacement(result: CheckResult) -> str:
    states = {name: case.large_displacement for name, case in result.load_cases.items()}
    followed = [name for name, moved in states.items() if moved.followed]
    blind = [name for name, moved in states.items() if moved.state in ("off", "unknown")]
    small = [name for name in states if name not in followed and name not in blind]
    told = []
    if small:
        told.append(f"{_under(result, small)}forces follow from the shape before loading, since it moves little")
    if blind:
        told.append(f"{_under(result, blind)}forces follow from the shape before loading, however far it may move")
    if followed:
        told.append(f"{_under(result, followed)}the deformed shape was followed under loads that keep their direction")
        stated = [result.case.load_cases[name] for name in followed]
        axes = {force.axes for case in stated for force in case.forces}
        if "link" in axes | {spread.axes for case in stated for spread in case.spread}:
            told.append(
                "a load in the axes of its link turns with it from pose to pose, but not as the linkage deforms"
            )
    text = "; ".join(told)
    return f"{text[:1].upper()}{text[1:]}."


def _under(result: CheckResult, names: list[str]) -> str:
    return "" if len(names) == len(result.load_cases) else f"under {joined(names)} "


def _buckling(result: CheckResult) -> str:
    judged = {
        check.subject
        for case in result.load_cases.values()
        for check in case.checks
        if check.quantity is Quantity.BUCKLING_FACTOR
    }
    links = [link for link in result.case.checked_links if Subject.link(link) in judged]
    found = (
        f"{joined(links)} {_was(links)} judged" if links else "No link is in compression; one that is would be judged"
    )
    found += f" as {'straight elastic columns' if len(links) > 1 else 'a straight elastic column'}"
    found += ": crookedness and thin walls that buckle by themselves are left out"
    followed = all(case.large_displacement.followed for case in result.load_cases.values())
    unseen = [n for n, case in result.load_cases.items() if case.large_displacement.buckling is None]
    if unseen:
        found += f". Buckling of all links together was not looked into {_under(result, unseen)}".rstrip()
    elif LINKAGE in judged and not followed:
        found += ". All links together were judged by linear theory"
    return f"{found}."


def _scatter(result: CheckResult) -> str:
    case = result.case
    used = dict.fromkeys(case.part_of(link).material for link in case.checked_links)
    bare = {
        "strength": [name for name in used if case.all_materials[name].strength_range is None],
        "modulus": [name for name in used if case.all_materials[name].youngs_modulus_range is None],
        "the loads": [name for name in result.load_cases if len(set(case.load_cases[name].scatter)) == 1],
    }
    whole = {"strength": len(used), "modulus": len(used), "the loads": len(result.load_cases)}
    missing = [
        what if len(names) == whole[what] else f"{what} ({joined(names)})" for what, names in bare.items() if names
    ]
    text = "Voids, layers, notches and scatter of dimensions are left to the safety factor"
    if missing:
        text += f", and so is scatter of {joined(missing)}, for which no range is stated"
    return f"{text}. Ranges that are stated are in the bands."


def _bands(result: CheckResult) -> str:
    every = [link for case in result.load_cases.values() for link in case.links.values()]
    loaded = [link for link in every if not math.isinf(link.safety_factor.value)]
    alone = _names(link for link in loaded if link.safety_factor.without)
    solid = _names(link for link in loaded if link.link not in alone and link.fidelity != "beam")
    hand = _names(link for link in loaded if link.link not in (*alone, *solid))
    told = []
    if solid:
        told.append(f"the error of the meshes of {joined(solid)} is in their bands as an estimate, which is no bound")
    if hand:
        told.append(f"no mesh of {joined(hand)} ran: their bands are what solid models of like parts gave")
    if alone:
        reasons = [link.safety_factor.without for link in loaded]
        why = joined(list(dict.fromkeys(filter(None, reasons))))
        told.append(f"{joined(alone)} {'has' if len(alone) == 1 else 'have'} no band of model error ({why})")
    text = "; ".join(told)
    return f"{text[:1].upper()}{text[1:]}." if text else "Nothing acts on any link that was checked."


def _was(names: list[str]) -> str:
    return "was" if len(names) == 1 else "were"


def _names(links: Iterable[LinkResult]) -> list[str]:
    return list(dict.fromkeys(link.link for link in links))
